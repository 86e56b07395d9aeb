#include "render/aov/aov_renderer.h"

#include "core/check.h"
#include "render/aov/surface_motion.h"
#include "render/aov/water_depths.h"
#include "render/shapes/drawn_shape.h"
#include "scene/description/looks.h"

#include <algorithm>
#include <array>

namespace tumble {
namespace {

/// Adjacent pixels of a row that show one surface.
struct PixelRun {
    std::uint32_t surface;
    std::size_t pixel;  // index of the first one
    int column, row;    // of the first one
    int count;
};

/// Calls visit(run) for all pixels, from the top left.
template <class Visit>
void for_each_run(const VisibilityBuffer& map, const Visit& visit) {
    const std::uint32_t* surface = map.surface.data();
    for (int row = 0; row < map.height; ++row, surface += map.width)
        for (int column = 0, end = 0; column < map.width; column = end) {
            end = column + 1;
            while (end < map.width && surface[end] == surface[column]) ++end;
            visit(PixelRun{surface[column], map.at(column, row), column, row, end - column});
        }
}

/// Repeats the value of a pixel of three channels.
template <class Value>
void fill_three(Value* to, const Value* value, int count) {
    for (int i = 0; i < count; ++i, to += 3) {
        to[0] = value[0];
        to[1] = value[1];
        to[2] = value[2];
    }
}

void fill_depth(const VisibilityBuffer& map, std::vector<float>& values) {
    values.assign(map.depth.begin(), map.depth.end());
}

/// Fills a pixel from a value that is constant over a surface.
template <class Value>
void fill_by_surface(const VisibilityBuffer& map, const std::vector<Value>& of_surface, const Value& of_nothing,
                     std::vector<Value>& values) {
    values.resize(map.surface.size());
    for_each_run(map, [&](const PixelRun& run) {
        std::fill_n(values.data() + run.pixel, run.count,
                    run.surface == VisibilityBuffer::nothing ? of_nothing : of_surface[run.surface]);
    });
}

std::vector<std::int32_t> ids_of(const SceneDescription& scene, const std::vector<ShapeInstance>& parts) {
    std::vector<std::int32_t> ids;
    for (const ShapeInstance& part : parts) ids.push_back(std::int32_t(body_id(part.body)));
    for (std::size_t i = 0; i < scene.cords.size(); ++i) ids.push_back(std::int32_t(cord_id(scene, i)));
    ids.push_back(std::int32_t(water_id(scene)));
    return ids;
}

void fill_albedo(const VisibilityBuffer& map, const SceneDescription& scene, const std::vector<ShapeInstance>& parts,
                 const ScenePlaces& places, const PinholeCamera& camera, std::vector<std::uint8_t>& values) {
    std::vector<Color> colors;
    std::vector<MeshMaterial> images;  // without a texture: one color
    for (const ShapeInstance& part : parts) {
        colors.push_back(part.color);
        Appearance look = scene.bodies[part.body].appearance;
        look.color = part.color;
        images.push_back(look.texture ? texture_material(part.shape, look) : MeshMaterial());
    }
    for (const CordDescription& cord : scene.cords) colors.push_back(cord.color);
    if (scene.water) colors.push_back(scene.water->color);
    values.resize(3 * map.surface.size());
    for_each_run(map, [&](const PixelRun& run) {
        std::uint8_t* to = values.data() + 3 * run.pixel;
        const auto* mesh = run.surface < parts.size() ? std::get_if<MeshShape>(&parts[run.surface].shape) : nullptr;
        if (mesh != nullptr && mesh->painted) {
            for (int i = 0; i < run.count; ++i, to += 3) {
                const Vec3 ray(camera.ray_x(run.column + i), camera.ray_y(run.row), 1.0);
                const Color color =
                    painted_color(*mesh, places.parts[run.surface], map.triangle[run.pixel + std::size_t(i)], ray);
                to[0] = color.r, to[1] = color.g, to[2] = color.b;
            }
            return;
        }
        if (run.surface < parts.size() && images[run.surface].texture) {
            const ShapeInstance& part = parts[run.surface];
            const PartPlace& place = places.parts[run.surface];
            const double scale = scene.bodies[part.body].appearance.texture_scale;
            for (int i = 0; i < run.count; ++i, to += 3) {
                const Vec3 ray(camera.ray_x(run.column + i), camera.ray_y(run.row), 1.0);
                const std::size_t pixel = run.pixel + std::size_t(i);
                const double depth = map.depth[pixel];
                const Vec3 position = place.axes.transpose() * (depth * ray - place.origin);
                const auto normal_of = [&](const auto& shape) {
                    return surface_normal(shape, place, map.triangle[pixel], ray, depth);
                };
                const TexturePlace at = texture_place(part.shape, position, std::visit(normal_of, part.shape), scale);
                const Color color =
                    encoded(color_at(images[run.surface], {float(at[0]), float(at[1])}, {1.0f, 1.0f, 1.0f}));
                to[0] = color.r, to[1] = color.g, to[2] = color.b;
            }
            return;
        }
        const Color color = run.surface == VisibilityBuffer::nothing ? Color{} : colors[run.surface];
        const std::array<std::uint8_t, 3> bytes{color.r, color.g, color.b};
        fill_three(to, bytes.data(), run.count);
    });
}

// Toward the side of the eye.
Vec3 water_normal(const WaterSurface& water, double time, const PinholeCamera& camera, const Vec3& point) {
    const Vec3 ray = camera.axes * point, at = camera.eye + ray;
    const Vec3 normal = water.normal(at.x(), at.z(), time);
    return normal.dot(ray) > 0.0 ? Vec3(-normal) : normal;
}

void fill_normal(const VisibilityBuffer& map, const std::vector<ShapeInstance>& parts, const ScenePlaces& places,
                 const Snapshot& snapshot, const PinholeCamera& camera, const WaterSurface& water,
                 std::vector<float>& values) {
    std::vector<Mat3> rotations;           // rotation of each part to the world
    std::vector<const float*> everywhere;  // of planes: their constant normal
    std::vector<std::array<float, 3>> planes(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        rotations.push_back((snapshot.bodies[parts[i].body].orientation * parts[i].rotation).toRotationMatrix());
        const auto* plane = std::get_if<PlaneShape>(&parts[i].shape);
        everywhere.push_back(plane != nullptr ? planes[i].data() : nullptr);
        if (plane != nullptr)
            Eigen::Map<Eigen::Vector3f>(planes[i].data()) = (rotations[i] * plane->normal).cast<float>();
    }
    const std::array<float, 3> zero{};
    values.resize(3 * map.surface.size());
    const auto normal_at = [&](std::uint32_t surface, std::size_t pixel, const Vec3& ray) -> Vec3 {
        const double depth = map.depth[pixel];
        if (surface >= parts.size() + places.cords.size())
            return water_normal(water, snapshot.time, camera, depth * ray);
        if (surface >= parts.size())
            return camera.axes * cord_normal(places.cords[surface - parts.size()], depth * ray);
        const auto normal_of = [&](const auto& shape) {
            return surface_normal(shape, places.parts[surface], map.triangle[pixel], ray, depth);
        };
        return rotations[surface] * std::visit(normal_of, parts[surface].shape);
    };
    for_each_run(map, [&](const PixelRun& run) {
        const float* known = run.surface == VisibilityBuffer::nothing ? zero.data()
                             : run.surface < parts.size()             ? everywhere[run.surface]
                                                                      : nullptr;
        float* to = values.data() + 3 * run.pixel;
        if (known != nullptr) return fill_three(to, known, run.count);
        for (int i = 0; i < run.count; ++i, to += 3) {
            const Vec3 ray(camera.ray_x(run.column + i), camera.ray_y(run.row), 1.0);
            const Vec3 normal = normal_at(run.surface, run.pixel + std::size_t(i), ray);
            for (std::size_t k = 0; k < 3; ++k) to[k] = float(normal[Eigen::Index(k)]);
        }
    });
}

void fill_motion(const VisibilityBuffer& map, const SurfaceMotion& motion, const PinholeCamera& camera,
                 std::vector<float>& values) {
    values.resize(2 * map.surface.size());
    for_each_run(map, [&](const PixelRun& run) {
        const bool background = run.surface == VisibilityBuffer::nothing;
        float* to = values.data() + 2 * run.pixel;
        if (background ? motion.background_rests() : motion.rests(run.surface)) {
            std::fill_n(to, 2 * run.count, 0.0f);
            return;
        }
        for (int column = run.column; column < run.column + run.count; ++column, to += 2) {
            const Vec3 ray(camera.ray_x(column), camera.ray_y(run.row), 1.0);
            const Eigen::Vector2d way =
                background ? motion.of_nothing(ray, column, run.row)
                           : motion.of_surface(run.surface, map.depth[map.at(column, run.row)] * ray, column, run.row);
            to[0] = float(way.x());
            to[1] = float(way.y());
        }
    });
}

bool same_poses(const Snapshot& a, const Snapshot& b) {
    return std::ranges::equal(a.bodies, b.bodies, [](const BodyState& x, const BodyState& y) {
        return x.origin == y.origin && x.orientation.coeffs() == y.orientation.coeffs();
    });
}

}  // namespace

AovRenderer::AovRenderer(const SceneDescription& scene, const AovSet& aovs)
    : scene_(scene),
      aovs_(aovs),
      path_(scene.camera),
      frame_{PinholeCamera(Camera(scene.camera, scene.output.width, scene.output.height)), {}, {}, {}, {}, {}},
      parts_(surface_parts(scene)),
      finder_(parts_, scene.cords) {
    if (scene.water) water_ = WaterSurface(*scene.water, scene.simulation.gravity.norm());
}

PinholeCamera AovRenderer::camera_at(const Snapshot& snapshot) const {
    return PinholeCamera(Camera(path_.at(snapshot), scene_.output.width, scene_.output.height));
}

const AovFrame& AovRenderer::make(const AovPoses& poses) {
    TUMBLE_CHECK_EQ(poses.now.bodies.size(), scene_.bodies.size());
    const PinholeCamera camera = camera_at(poses.now);
    const ScenePlaces places = make_places(parts_, scene_.cords, poses.now, camera);
    VisibilityBuffer& map = finder_.find(places, camera);
    if (shows_water(scene_))
        add_water(water_, poses.now.time, camera, std::uint32_t(parts_.size() + scene_.cords.size()), map);

    AovFrame& frame = frame_;
    frame.camera = camera;
    if (aovs_.has(Aov::depth)) fill_depth(map, frame.depth);
    if (aovs_.has(Aov::normal)) fill_normal(map, parts_, places, poses.now, camera, water_, frame.normal);
    if (aovs_.has(Aov::segmentation)) fill_by_surface(map, ids_of(scene_, parts_), std::int32_t(0), frame.segmentation);
    if (aovs_.has(Aov::albedo)) fill_albedo(map, scene_, parts_, places, camera, frame.albedo);
    if (aovs_.has(Aov::motion)) {
        TUMBLE_CHECK_EQ(poses.next.has_value(), true);
        const PinholeCamera next_camera = camera_at(*poses.next);
        const ScenePlaces next = make_places(parts_, scene_.cords, *poses.next, next_camera);
        fill_motion(map, SurfaceMotion(places, camera, next, next_camera), camera, frame.motion);
    }
    return frame;
}

bool AovChanges::follow(const AovPoses& poses) {
    const auto same = [&](const Snapshot& a, const Snapshot& b) {
        return same_poses(a, b) && same_place(path_.at(a), path_.at(b));
    };
    const bool unmoved =
        before_ && !waves_ && same(before_->now, poses.now) && (!poses.next || same(*before_->next, *poses.next));
    if (!unmoved) before_ = poses;
    return !unmoved;
}

}  // namespace tumble
