#include "render/draw_list.h"

#include "core/check.h"
#include "render/glm_conversion.h"
#include "render/surface_ids.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tumble {
namespace {

// A ball's outline may leave the true circle by this much.
constexpr double outline_error = 0.15;  // pixels

// The angle between neighbouring vertices of the icosahedron itself; each level of splitting halves it.
constexpr double icosahedron_angle = 1.10714871779409;  // rad, atan 2

constexpr float cord_roughness = 0.7f;

// Bodies are drawn in shells around the eye, the nearest first, and within a shell by mesh and shader: what is hidden is
// mostly rejected, and there are few changes of shaders.
constexpr double shells_per_doubling = 8.0;   // of the distance

struct Item {
    std::size_t mesh;
    bool patterned, lit;
    double distance;
    Instance instance;
    int shell() const { return int(std::floor(shells_per_doubling * std::log2(std::max(distance, 1e-30)))); }
};

// An edge of angle a lies at most r (1 - cos(a / 2)) = r a^2 / 8 inside the circle of radius r.
std::size_t ball_mesh_for(double radius, double error) {   // m
    std::size_t level = 0;
    double angle = icosahedron_angle;
    while (level + 1 < ball_levels && radius * angle * angle / 8.0 > error) {
        ++level;
        angle *= 0.5;
    }
    return first_ball_mesh + level;
}

Instance instance_of(const BodyLook& look, const BodyState& state, const CameraView& view,
                     const OcclusionPlace& place, std::size_t body, bool near_shadows) {
    return {to_glm(view.relative(state.origin), look.bevel),
            to_glm(state.orientation),
            to_glm(look.half_size, look.pattern_cell),
            glm::vec4(look.color, look.roughness),
            glm::vec4(look.metallic, pattern_number(look.pattern), float(place.x), float(place.y)),
            glm::vec4(float(place.size), 0.0f, surface_alpha(body, 0), near_shadows ? 1.0f : 0.0f)};
}

Item cord_item(const CordDescription& cord, std::size_t number, const Snapshot& snapshot, const CameraView& view,
               const ShadowFit& shadows) {
    const BodyState& state = snapshot.bodies[cord.body];
    const Vec3 from = view.relative(cord.anchor);
    const Vec3 to = view.relative(state.origin + state.orientation * cord.point);
    const Vec3 middle = 0.5 * (from + to);
    const double length = (to - from).norm();
    const Quat turn =
        Quat::FromTwoVectors(Vec3::UnitY(), length > 0.0 ? Vec3((to - from) / length) : Vec3(Vec3::UnitY()));
    const std::array<double, 3> c = to_linear(cord.color);
    const Vec3 scale(cord.radius, std::max(0.5 * length, 1e-3 * cord.radius), cord.radius);
    return {cylinder_mesh,
            false,
            true,
            middle.norm(),
            {to_glm(middle, 0.0), to_glm(turn), to_glm(scale, cord.radius),
             glm::vec4(float(c[0]), float(c[1]), float(c[2]), cord_roughness), glm::vec4(0.0f),
             glm::vec4(0.0f, 0.0f, surface_alpha(number, 0),
                       shadows.near_holds(middle, 0.5 * length + cord.radius) ? 1.0f : 0.0f)}};
}

// The faces of a box that can be seen, those in the sun apart from the others.
void add_faces(Item item, std::size_t body, std::uint8_t faces, const Quat& orientation, const Vec3& light, std::vector<Item>& items) {
    const Mat3 axes = orientation.toRotationMatrix();
    item.mesh = face_mesh;
    for (int face = 0; face < 6; ++face) {
        if ((faces >> face & 1) == 0) continue;
        const Vec3 normal = axes.col(face / 2) * (face % 2 == 0 ? -1.0 : 1.0);
        item.lit = normal.dot(light) < 0.0;
        item.instance.tile.y = float(face);
        item.instance.tile.z = surface_alpha(body, std::size_t(face));
        items.push_back(item);
    }
}

// The half box has the faces on the high sides: mirrored so that they are those in the sun.
void turn_to_light(Instance& half_box, const Quat& orientation, const Vec3& light) {
    const Vec3 there = orientation.conjugate() * light;
    for (int axis = 0; axis < 3; ++axis)
        if (there[axis] > 0.0) half_box.scale[axis] = -half_box.scale[axis];
}

std::size_t mesh_of(const BodyLook& look, const SceneLooks& looks, const BoundingBall& ball, const CameraView& view) {
    switch (look.kind) {
        case DrawKind::ball:
            return ball_mesh_for(ball.radius, outline_error * view.pixel_size() *
                                                  std::max(ball.center.norm() - ball.radius, 1e-3 * ball.radius));
        case DrawKind::mesh:
            return scene_mesh(look.mesh, level_in_view(look, looks, ball.center, view));
        default:
            return half_box_mesh;
    }
}

// As fine as the shadow map that it is drawn into.
std::size_t caster_mesh(const BodyLook& look, const SceneLooks& looks, const BoundingBall& ball, const ShadowFit& shadows) {
    const double texel = !shadows.has_far || shadows.near_holds(ball.center, ball.radius) ? shadows.near_texel
                         : std::min(shadows.near_texel, shadows.far_texel);
    if (look.kind == DrawKind::ball) return ball_mesh_for(ball.radius, most_detail_error * texel);
    return scene_mesh(look.mesh, level_for(look, looks, most_detail_error * texel));
}

// Appends the items to the instances, as batches of one mesh, nearest first; equal ones keep the scene's order.
std::vector<Batch> append_batches(const std::vector<Item>& items, std::vector<Instance>& instances, bool in_shells) {
    struct Key {
        std::uint64_t order;   // shell, mesh, shader
        float distance;
        std::uint32_t item;
    };
    std::vector<Key> keys;
    keys.reserve(items.size());
    for (const Item& item : items) {
        const std::uint64_t shell = in_shells ? std::uint64_t(item.shell() + 100000) : 0;
        keys.push_back({shell << 40 | std::uint64_t(item.mesh) << 2 | (item.patterned ? 2u : 0u) | (item.lit ? 1u : 0u),
                        float(item.distance), std::uint32_t(keys.size())});
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return std::tie(a.order, a.distance, a.item) < std::tie(b.order, b.distance, b.item);
    });
    std::vector<Batch> batches;
    instances.reserve(instances.size() + items.size());
    for (const Key& key : keys) {
        const Item& item = items[key.item];
        if (batches.empty() || batches.back().mesh != item.mesh || batches.back().patterned != item.patterned ||
            batches.back().lit != item.lit)
            batches.push_back({item.mesh, item.patterned, item.lit, instances.size(), 0});
        instances.push_back(item.instance);
        ++batches.back().count;
    }
    return batches;
}

}  // namespace

DrawList make_draw_list(const SceneDescription& scene, const SceneLooks& looks, const Snapshot& snapshot,
                        const CameraView& view, const Visibility& visibility, const OcclusionAtlas& atlas,
                        const ShadowFit& shadows, const std::vector<char>& wanted,
                        const std::vector<char>& casting) {
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), looks.bodies.size());
    const Vec3 light = scene.light.direction.normalized();
    std::vector<Item> visible, casters;
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        const BodyLook& look = looks.bodies[i];
        if (look.kind == DrawKind::hidden || look.kind == DrawKind::plane) continue;
        const BoundingBall ball = bounding_ball(look, snapshot.bodies[i], view);
        const bool in_view = visibility.bodies[i] && wanted[i] != 0;
        const bool casts = scene.light.shadows && casting[i] != 0 && view.sees_swept(ball.center, ball.radius, light);
        if (!in_view && !casts) continue;
        const Item item = {mesh_of(look, looks, ball, view), look.pattern != Pattern::plain, true, ball.center.norm(),
                           instance_of(look, snapshot.bodies[i], view, atlas.places[i], i,
                                       shadows.near_holds(ball.center, ball.radius))};
        if (casts) {
            casters.push_back(item);
            if (look.kind == DrawKind::box) turn_to_light(casters.back().instance, snapshot.bodies[i].orientation, light);
            if (look.kind != DrawKind::box) casters.back().mesh = caster_mesh(look, looks, ball, shadows);
        }
        if (!in_view) continue;
        if (look.kind == DrawKind::box) {
            add_faces(item, i, visibility.faces[i], snapshot.bodies[i].orientation, light, visible);
        } else {
            visible.push_back(item);
        }
    }
    for (std::size_t i = 0; i < scene.cords.size(); ++i) {
        const Item item = cord_item(scene.cords[i], looks.bodies.size() + i, snapshot, view, shadows);
        if (wanted[looks.bodies.size() + i] != 0) visible.push_back(item);
        if (scene.light.shadows && casting[looks.bodies.size() + i] != 0) casters.push_back(item);
    }
    DrawList list;
    list.visible = append_batches(visible, list.instances, true);
    list.casters = append_batches(casters, list.instances, false);
    return list;
}

}  // namespace tumble
