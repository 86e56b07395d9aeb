#include "render/passes/draw_list.h"

#include "core/check.h"
#include "core/rotation.h"
#include "render/antialiasing/surface_ids.h"
#include "render/gl/glm_conversion.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tumble {
namespace {

// Largest deviation of a ball's outline from the circle.
constexpr double outline_error = 0.15;  // pixels, or texels of a shadow map

// The angle between adjacent vertices of the icosahedron; each subdivision halves it.
constexpr double icosahedron_angle = 1.10714871779409;  // rad, atan 2

constexpr float cord_roughness = 0.7f;

// Draw order: by shells around the eye, the nearest first, and within a shell by mesh and shader. Hidden pixels are
// mostly rejected, and shader changes are few.
constexpr double shells_per_doubling = 8.0;  // per doubling of the distance

constexpr double shell_offset = 100000.0;  // keeps shell numbers positive

// One item before sorting.
struct Item {
    std::uint64_t order;   // key by shell, mesh and shader
    float distance;        // m
    std::uint32_t number;  // index of the body; cords follow the bodies
    std::uint32_t mesh;
    std::uint8_t face;  // of a box
    bool patterned, lit, spans_cascades;
    bool charted = false;  // given by the mesh
};

Item make_item(std::size_t mesh, bool patterned, bool lit, bool spans_cascades, double distance, std::size_t number,
               int face, bool in_shells) {
    const double shell =
        in_shells ? std::floor(shells_per_doubling * std::log2(std::max(distance, 1e-30))) + shell_offset : 0.0;
    return {std::uint64_t(shell) << 40 | std::uint64_t(mesh) << 3 | (spans_cascades ? 4u : 0u) | (patterned ? 2u : 0u) |
                (lit ? 1u : 0u),
            float(distance),
            std::uint32_t(number),
            std::uint32_t(mesh),
            std::uint8_t(face),
            patterned,
            lit,
            spans_cascades};
}

// An edge of angle a lies at most r (1 - cos(a / 2)) = r a^2 / 8 inside the circle of radius r.
std::size_t ball_mesh_for(double radius, double error) {  // m
    std::size_t level = 0;
    double angle = icosahedron_angle;
    while (level + 1 < ball_levels && radius * angle * angle / 8.0 > error) {
        ++level;
        angle *= 0.5;
    }
    return first_ball_mesh + level;
}

Instance instance_of(const RenderBody& proxy, const BodyState& state, const Camera& view, const OcclusionPlace& place,
                     std::size_t body, bool near_shadows) {
    return {to_glm(view.relative(state.origin), proxy.bevel),
            to_glm(state.orientation),
            to_glm(proxy.half_size, proxy.pattern_cell),
            glm::vec4(proxy.color, proxy.roughness),
            glm::vec4(proxy.metallic, pattern_number(proxy.pattern), float(place.x), float(place.y)),
            glm::vec4(float(place.size), 0.0f, surface_alpha(body, 0), near_shadows ? 1.0f : 0.0f)};
}

struct CordPlace {
    Vec3 middle;
    double length;
    Quat turn;
};

CordPlace place_cord(const CordDescription& cord, const Snapshot& snapshot, const Camera& view) {
    const BodyState& state = snapshot.bodies[cord.body];
    const Vec3 from = view.relative(cord.anchor);
    const Vec3 to = view.relative(state.origin + state.orientation * cord.point);
    const double length = (to - from).norm();
    return {0.5 * (from + to), length,
            turn_between(Vec3::UnitY(), length > 0.0 ? Vec3((to - from) / length) : Vec3(Vec3::UnitY()))};
}

Instance cord_instance(const CordDescription& cord, std::size_t number, const CordPlace& place,
                       const ShadowCascades& shadows) {
    const std::array<double, 3> c = to_linear(cord.color);
    const Vec3 scale(cord.radius, std::max(0.5 * place.length, 1e-3 * cord.radius), cord.radius);
    return {to_glm(place.middle, 0.0),
            to_glm(place.turn),
            to_glm(scale, cord.radius),
            glm::vec4(float(c[0]), float(c[1]), float(c[2]), cord_roughness),
            glm::vec4(0.0f),
            glm::vec4(0.0f, 0.0f, surface_alpha(number, 0),
                      shadows.near_holds(place.middle, 0.5 * place.length + cord.radius) ? 1.0f : 0.0f)};
}

// The half box has the faces on the high sides; they are mirrored to be those towards the sun.
void turn_to_light(Instance& half_box, const Quat& orientation, const Vec3& light) {
    const Vec3 there = orientation.conjugate() * light;
    for (int axis = 0; axis < 3; ++axis)
        if (there[axis] > 0.0) half_box.scale[axis] = -half_box.scale[axis];
}

std::size_t mesh_of(const RenderBody& proxy, const RenderScene& scene, const BoundingBall& ball, const Camera& view) {
    switch (proxy.kind) {
        case DrawKind::ball:
            return ball_mesh_for(ball.radius, outline_error * view.pixel_size() *
                                                  std::max(ball.center.norm() - ball.radius, 1e-3 * ball.radius));
        case DrawKind::mesh:
            return scene_mesh(proxy.mesh, level_in_view(proxy, scene, ball.center, view));
        default:
            return half_box_mesh;
    }
}

// Level of detail for the resolution of the item's shadow map.
std::size_t caster_mesh(const RenderBody& proxy, const RenderScene& scene, const BoundingBall& ball, const Camera& view,
                        const ShadowCascades& shadows) {
    const double texel = shadows.may_look_far(ball.center, ball.radius)
                             ? std::min(shadows.near_texel, shadows.far_texel)
                             : shadows.near_texel;
    if (proxy.kind == DrawKind::ball)
        return scene.bodies.size() < large_scene ? mesh_of(proxy, scene, ball, view)
                                                 : ball_mesh_for(ball.radius, outline_error * texel);
    return scene_mesh(proxy.mesh, level_for(proxy, scene, most_detail_error * texel));
}

// Appends the items' instances as batches of one mesh, nearest first; equal items keep the scene's order.
template <class Make>
std::vector<Batch> append_batches(std::vector<Item>& items, std::vector<Instance>& instances, const Make& make) {
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
        return std::tie(a.order, a.distance, a.number, a.face) < std::tie(b.order, b.distance, b.number, b.face);
    });
    std::vector<Batch> batches;
    for (const Item& item : items) {
        if (batches.empty() || batches.back().mesh != item.mesh || batches.back().patterned != item.patterned ||
            batches.back().lit != item.lit || batches.back().spans_cascades != item.spans_cascades)
            batches.push_back(
                {item.mesh, item.patterned, item.lit, item.spans_cascades, item.charted, instances.size(), 0});
        instances.push_back(make(item));
        ++batches.back().count;
    }
    return batches;
}

}  // namespace

DrawList make_draw_list(const SceneDescription& description, const RenderScene& scene, const Snapshot& snapshot,
                        const Camera& view, const Visibility& visibility, const OcclusionAtlas& atlas,
                        const ShadowCascades& shadows, const std::vector<char>& draw_mask,
                        const std::vector<char>& caster_mask) {
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), scene.bodies.size());
    const std::size_t bodies = scene.bodies.size();
    const Vec3 light = description.light.direction.normalized();
    std::vector<Item> visible, casters;
    for (std::size_t i = 0; i < bodies; ++i) {
        const RenderBody& proxy = scene.bodies[i];
        if (proxy.kind == DrawKind::hidden || proxy.kind == DrawKind::plane) continue;
        const BoundingBall ball = bounding_ball(proxy, snapshot.bodies[i], view);
        const bool in_view = visibility.bodies[i] && draw_mask[i] != 0;
        const bool casts = description.light.shadows && caster_mask[i] != 0;
        const bool patterned = proxy.pattern != Pattern::plain;
        const double distance = ball.center.norm();
        if (casts) {
            const std::size_t mesh =
                proxy.kind == DrawKind::box ? half_box_mesh : caster_mesh(proxy, scene, ball, view, shadows);
            casters.push_back(make_item(mesh, false, true, false, distance, i, 0, false));
        }
        if (!in_view) continue;
        const bool spans_cascades = description.light.shadows && shadows.spans_maps(ball.center, ball.radius);
        if (proxy.kind != DrawKind::box) {
            visible.push_back(
                make_item(mesh_of(proxy, scene, ball, view), patterned, true, spans_cascades, distance, i, 0, true));
            visible.back().charted = proxy.kind == DrawKind::mesh && scene.meshes[proxy.mesh].charts.has_value();
            continue;
        }
        // Visible faces of the box: lit ones are separate from unlit ones.
        const Vec3 there = snapshot.bodies[i].orientation.conjugate() * light;
        for (int face = 0; face < 6; ++face)
            if ((visibility.faces[i] >> face & 1) != 0) {
                const bool lit = there[face / 2] * (face % 2 == 0 ? -1.0 : 1.0) < 0.0;
                visible.push_back(make_item(face_mesh, patterned, lit, spans_cascades && lit, distance, i, face, true));
            }
    }
    std::vector<CordPlace> cords;
    for (std::size_t i = 0; i < description.cords.size(); ++i) {
        cords.push_back(place_cord(description.cords[i], snapshot, view));
        const double distance = cords.back().middle.norm();
        if (draw_mask[bodies + i] != 0)
            visible.push_back(make_item(cylinder_mesh, false, true, false, distance, bodies + i, 0, true));
        if (description.light.shadows && caster_mask[bodies + i] != 0)
            casters.push_back(make_item(cylinder_mesh, false, true, false, distance, bodies + i, 0, false));
    }
    const auto instance = [&](const Item& item) {
        const std::size_t i = item.number;
        if (i >= bodies) return cord_instance(description.cords[i - bodies], i, cords[i - bodies], shadows);
        const BoundingBall ball = bounding_ball(scene.bodies[i], snapshot.bodies[i], view);
        Instance made = instance_of(scene.bodies[i], snapshot.bodies[i], view, atlas.places[i], i,
                                    shadows.near_holds(ball.center, ball.radius));
        const bool open_mesh = scene.bodies[i].kind == DrawKind::mesh && !scene.meshes[scene.bodies[i].mesh].closed;
        made.tile.y = open_mesh ? 1.0f : float(item.face);
        made.tile.z = surface_alpha(i, item.face);
        if (item.mesh == half_box_mesh) turn_to_light(made, snapshot.bodies[i].orientation, light);
        return made;
    };
    DrawList list;
    list.instances.reserve(visible.size() + casters.size());
    list.visible = append_batches(visible, list.instances, instance);
    list.casters = append_batches(casters, list.instances, instance);
    return list;
}

}  // namespace tumble
