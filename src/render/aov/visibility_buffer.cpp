#include "render/aov/visibility_buffer.h"
#include "core/rotation.h"

#include "render/aov/mesh_depths.h"
#include "render/aov/pinhole_camera.h"
#include "render/aov/ray_intersections.h"

#include <array>
#include <limits>

namespace tumble {
namespace {

/// Corners of a box in the camera frame.
std::array<Vec3, 8> corners_of(const PartPlace& place, const Vec3& middle, const Vec3& half_size) {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 sides((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
        corners[i] = place.origin + place.axes * (middle + half_size.cwiseProduct(sides));
    }
    return corners;
}

}  // namespace

void VisibilityBuffer::clear(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    depth.assign(pixels, std::numeric_limits<double>::infinity());
    surface.assign(pixels, nothing);
    triangle.resize(pixels);
}

ScenePlaces make_places(std::span<const ShapeInstance> parts, std::span<const CordDescription> cords,
                        const Snapshot& snapshot, const PinholeCamera& camera) {
    ScenePlaces places;
    places.parts.reserve(parts.size());
    for (const ShapeInstance& part : parts) places.parts.push_back(place_of(part, snapshot, camera));
    for (const CordDescription& cord : cords) places.cords.push_back(place_of(cord, snapshot, camera));
    return places;
}

VisibilityBufferRenderer::VisibilityBufferRenderer(std::span<const ShapeInstance> parts,
                                                   std::span<const CordDescription> cords)
    : parts_(parts), cords_(cords) {}

const VisibilityBuffer& VisibilityBufferRenderer::find(const ScenePlaces& places, const PinholeCamera& camera) {
    map_.clear(camera.width, camera.height);
    ray_x_.clear();
    for (int column = 0; column < camera.width; ++column) ray_x_.push_back(camera.ray_x(column));
    depths_.resize(ray_x_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i)
        std::visit([&](const auto& shape) { find_shape(shape, i, places.parts[i], camera); }, parts_[i].shape);
    for (std::size_t i = 0; i < cords_.size(); ++i) find_cord(i, places.cords[i], camera);
    return map_;
}

template <class Depths>
void VisibilityBufferRenderer::find_rows(std::span<const Vec3> hull, std::size_t index, const PinholeCamera& camera,
                                         const Depths& depths_of) {
    const PixelBounds bounds = pixel_bounds(hull, camera);
    for (int row = bounds.top; !bounds.empty() && row <= bounds.bottom; ++row) {
        const auto count = std::size_t(bounds.last - bounds.first + 1);
        depths_of(RayRow{ray_x_.data() + bounds.first, camera.ray_y(row), count}, depths_.data());
        double* const nearest = map_.depth.data() + map_.at(bounds.first, row);
        std::uint32_t* const surface = map_.surface.data() + map_.at(bounds.first, row);
        for (std::size_t i = 0; i < count; ++i) {
            if (!(depths_[i] < nearest[i])) continue;
            nearest[i] = depths_[i];
            surface[i] = std::uint32_t(index);
        }
    }
}

void VisibilityBufferRenderer::find_shape(const PlaneShape& plane, std::size_t index, const PartPlace& place,
                                          const PinholeCamera& camera) {
    const Vec3 normal = place.axes * plane.normal;
    const double height = -normal.dot(place.origin) - plane.offset;
    // A plane has no corners; its bounds are the whole image, as for a hull that contains the eye.
    const std::array<Vec3, 2> everywhere = {Vec3(0.0, 0.0, 1.0), Vec3(0.0, 0.0, -1.0)};
    find_rows(everywhere, index, camera,
              [&](const RayRow& rays, double* depths) { plane_depths(normal, height, rays, depths); });
}

void VisibilityBufferRenderer::find_shape(const BoxShape& box, std::size_t index, const PartPlace& place,
                                          const PinholeCamera& camera) {
    const Vec3 half_size = 0.5 * box.size;
    find_rows(corners_of(place, Vec3::Zero(), half_size), index, camera,
              [&](const RayRow& rays, double* depths) { box_depths(place, half_size, rays, depths); });
}

void VisibilityBufferRenderer::find_shape(const SphereShape& ball, std::size_t index, const PartPlace& place,
                                          const PinholeCamera& camera) {
    const PartPlace upright{Mat3::Identity(), place.origin};
    find_rows(corners_of(upright, Vec3::Zero(), Vec3::Constant(ball.radius)), index, camera,
              [&](const RayRow& rays, double* depths) { ball_depths(place.origin, ball.radius, rays, depths); });
}

void VisibilityBufferRenderer::find_shape(const MeshShape& mesh, std::size_t index, const PartPlace& place,
                                          const PinholeCamera& camera) {
    vertices_.clear();
    for (const MeshAsset::Vertex& v : mesh.asset->vertices)
        vertices_.push_back(place.origin + place.axes * Vec3(v.position[0], v.position[1], v.position[2]));
    if (vertices_.empty() || pixel_bounds(vertices_, camera).empty()) return;
    const MeshTriangles triangles{vertices_, mesh.asset->indices, parts_[index].closed};
    find_triangles(triangles, std::uint32_t(index), camera, ray_x_, map_);
}

void VisibilityBufferRenderer::find_cord(std::size_t index, const CordPlace& place, const PinholeCamera& camera) {
    const double radius = cords_[index].radius;
    const Vec3 axis = place.to - place.from;
    const Quat turn = rotation_between(Vec3::UnitY(), axis);
    const PartPlace around{turn.toRotationMatrix(), 0.5 * (place.from + place.to)};
    find_rows(corners_of(around, Vec3::Zero(), Vec3(radius, 0.5 * axis.norm(), radius)), parts_.size() + index, camera,
              [&](const RayRow& rays, double* depths) { cord_depths(place, radius, rays, depths); });
}

}  // namespace tumble
