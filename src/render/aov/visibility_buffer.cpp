#include "render/aov/visibility_buffer.h"
#include "core/vector.h"

#include "render/aov/mesh_depths.h"
#include "render/aov/pinhole_camera.h"

#include <limits>

namespace tumble {

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

VisibilityBuffer& VisibilityBufferRenderer::find(const ScenePlaces& places, const PinholeCamera& camera) {
    map_.clear(camera.width, camera.height);
    ray_x_.clear();
    for (int column = 0; column < camera.width; ++column) ray_x_.push_back(camera.ray_x(column));
    depths_.resize(ray_x_.size());
    camera_ = &camera;
    for (surface_ = 0; surface_ < parts_.size(); ++surface_)
        std::visit([&](const auto& shape) { cast_rays(shape, places.parts[surface_], *this); }, parts_[surface_].shape);
    for (std::size_t i = 0; i < cords_.size(); ++i, ++surface_) cast_cord(places.cords[i], cords_[i].radius);
    return map_;
}

void VisibilityBufferRenderer::add_rows(std::span<const Vec3> hull, const Depths& depths) {
    const PixelBounds bounds = pixel_bounds(hull, *camera_);
    for (int row = bounds.top; !bounds.empty() && row <= bounds.bottom; ++row) {
        const auto count = std::size_t(bounds.last - bounds.first + 1);
        depths(RayRow{ray_x_.data() + bounds.first, camera_->ray_y(row), count}, depths_.data());
        double* const nearest = map_.depth.data() + map_.at(bounds.first, row);
        std::uint32_t* const surface = map_.surface.data() + map_.at(bounds.first, row);
        for (std::size_t i = 0; i < count; ++i) {
            if (!(depths_[i] < nearest[i])) continue;
            nearest[i] = depths_[i];
            surface[i] = std::uint32_t(surface_);
        }
    }
}

void VisibilityBufferRenderer::add_triangles(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices) {
    if (vertices.empty() || pixel_bounds(vertices, *camera_).empty()) return;
    const auto* mesh = std::get_if<MeshShape>(&parts_[surface_].shape);
    const MeshPaint* paint = mesh != nullptr ? mesh->paint() : nullptr;
    const MeshPaint* holes = paint != nullptr && paint->has_holes() ? paint : nullptr;
    const bool closed = parts_[surface_].closed && holes == nullptr;  // the inside is visible through holes
    find_triangles({vertices, indices, closed, holes}, std::uint32_t(surface_), *camera_, ray_x_, map_);
}

void VisibilityBufferRenderer::cast_cord(const CordPlace& place, double radius) {
    const Vec3 axis = place.to - place.from;
    const Quat turn = rotation_between(Vec3::UnitY(), axis);
    const PartPlace around{turn.toRotationMatrix(), 0.5 * (place.from + place.to)};
    add_rows(corners_of(around, Vec3(radius, 0.5 * axis.norm(), radius)),
             [&](const RayRow& rays, double* depths) { cord_depths(place, radius, rays, depths); });
}

}  // namespace tumble
