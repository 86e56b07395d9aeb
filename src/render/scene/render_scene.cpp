#include "render/scene/render_scene.h"

#include "core/error.h"
#include "render/scene/large_receivers.h"
#include "render/scene/plane_patch.h"
#include "render/shapes/drawn_shape.h"
#include "scene/description/lamps.h"
#include "scene/description/looks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tumble {
namespace {

constexpr std::size_t most_looks = 1 << 13;  // that the order of drawing has bits for

/// The index of the look, which is appended if it is new.
std::size_t look_index(const SurfaceLook& look, std::vector<SurfaceLook>& looks) {
    const auto same = [&](const SurfaceLook& other) {
        const MeshMaterial &a = look.image, &b = other.image;
        return look.pattern == other.pattern && a.texture == b.texture && a.wrap_u == b.wrap_u &&
               a.wrap_v == b.wrap_v && a.nearest == b.nearest && a.maps == b.maps;
    };
    const auto known = std::find_if(looks.begin(), looks.end(), same);
    if (known != looks.end()) return std::size_t(known - looks.begin());
    if (looks.size() == most_looks) throw RunError(fmt::format("the scene has more than {} textures", most_looks));
    looks.push_back(look);
    return looks.size() - 1;
}

/// A shape that is drawn as a mesh gets one with its texture.
void paint_mesh_of(const BodyDescription& body, RenderBody& proxy, RenderScene& scene) {
    RenderMesh mesh = scene.meshes[proxy.mesh];
    mesh.own_paint = texture_paint(body.shape, body.appearance, mesh.asset->vertices, mesh.asset->indices);
    mesh.paint = mesh.own_paint.get();
    proxy.mesh = scene.meshes.size();
    scene.meshes.push_back(std::move(mesh));
}

void set_look(const BodyDescription& body, RenderBody& proxy, RenderScene& scene) {
    const Appearance& look = body.appearance;
    const bool drawn_plain = proxy.kind == DrawKind::box || proxy.kind == DrawKind::ball;
    if (look.pattern_scale > 0.0) proxy.pattern_cell = look.pattern_scale;
    if (look.has_image() && proxy.kind == DrawKind::mesh) {
        if (!std::holds_alternative<MeshShape>(body.shape)) paint_mesh_of(body, proxy, scene);
    } else if (look.has_image()) {
        SurfaceLook image{Pattern::plain, texture_material(body.shape, look)};
        proxy.look = look_index(image, scene.looks);
        const auto [around, along] = images_around(body.shape, look.texture_scale);
        proxy.paint = glm::vec4(float(around), float(along), 0.0f, float(look.texture_scale));
        if (proxy.kind == DrawKind::plane) proxy.pattern_cell = look.texture_scale > 0.0 ? look.texture_scale : 1.0;
    } else if (two_colored(look)) {
        proxy.look = look_index({look.pattern}, scene.looks);
        const std::array<double, 3> second = to_linear(second_color(look));
        proxy.paint = glm::vec4(float(second[0]), float(second[1]), float(second[2]), 0.0f);
    } else if (look.pattern == Pattern::plain) {
        if (drawn_plain) proxy.look = look_index({look.pattern}, scene.looks);
    } else {
        proxy.pattern = look.pattern;
    }
}

/// Marks the fixed bodies that no camera sees, because a fixed plane hides them.
void find_buried(const SceneDescription& description, RenderScene& scene) {
    std::vector<PlaneShape> planes;
    for (const std::size_t i : scene.planes) {
        if (!scene.bodies[i].fixed) continue;
        BodyState state;
        state.origin = description.bodies[i].position;
        state.orientation = description.bodies[i].rotation;
        planes.push_back(plane_in_world(scene.bodies[i], state));
    }
    std::vector<Vec3> eyes;
    for (const CameraDescription* camera : description.camera.all()) {
        eyes.push_back(camera->eye);
        for (const CameraKeyframe& key : camera->keyframes) eyes.push_back(key.eye);
    }
    for (std::size_t i = 0; !planes.empty() && i < scene.bodies.size(); ++i) {
        RenderBody& proxy = scene.bodies[i];
        if (!proxy.fixed || !proxy.solid()) continue;
        const BodyDescription& body = description.bodies[i];
        const Vec3 center = body.position + body.rotation * proxy.bound_center;
        proxy.buried = std::ranges::all_of(
            eyes, [&](const Vec3& eye) { return hidden_behind(planes, eye, proxy, center, body.rotation); });
    }
}

}  // namespace

RenderScene describe_bodies(const SceneDescription& description) {
    RenderScene scene;
    scene.light = description.light;
    scene.lamps = description.lamps;
    scene.environment = description.environment;
    scene.water = description.water;
    if (scene.water) scene.surface = WaterSurface(*scene.water, description.simulation.gravity.norm());
    scene.exposure = description.output.exposure.value_or(0.0);
    scene.tone = description.output.tone.value_or(ToneCurve::filmic);
    scene.sun_up = sun_is_up(description);
    scene.cords = description.cords;
    for (const BodyDescription& body : description.bodies) {
        RenderBody proxy;
        proxy.fixed = body.type == BodyType::fixed && !body.fracture;
        if (body.piece_of) proxy.whole = *body.piece_of;
        if (body.appearance.visible) {
            std::visit([&](const auto& shape) { set_proxy(proxy, shape, scene.meshes); }, body.shape);
            const std::array<double, 3> linear = to_linear(body.appearance.color);
            proxy.color = {float(linear[0]), float(linear[1]), float(linear[2])};
            proxy.roughness = float(body.appearance.roughness);
            proxy.metallic = float(body.appearance.metallic);
            const std::array<double, 3> glow = to_linear(body.appearance.emission);
            proxy.glow = {float(glow[0]), float(glow[1]), float(glow[2]), float(body.appearance.opacity)};
            if (proxy.kind == DrawKind::plane) proxy.glow.w = 1.0f;  // bodies and shadows on it are drawn before
            set_look(body, proxy, scene);
        }
        if (proxy.kind == DrawKind::plane) scene.planes.push_back(scene.bodies.size());
        scene.bodies.push_back(proxy);
    }
    if (const auto mirror = mirror_of(description))
        scene.bodies[*mirror].reflection = float(description.bodies[*mirror].appearance.reflection);
    find_buried(description, scene);
    find_large_receivers(description, scene);
    std::vector<double> ao_radii;
    for (const RenderBody& proxy : scene.bodies)
        if (proxy.ao_radius > 0.0 && !proxy.large_receiver && !proxy.buried) ao_radii.push_back(proxy.ao_radius);
    if (!ao_radii.empty()) {
        const auto middle = ao_radii.begin() + std::ptrdiff_t(ao_radii.size() / 2);
        std::nth_element(ao_radii.begin(), middle, ao_radii.end());
        scene.typical_ao_radius = *middle;
    }
    for (const RenderBody& proxy : scene.bodies)
        if (proxy.kind == DrawKind::mesh) scene.mesh_triangles += scene.meshes[proxy.mesh].asset->indices.size() / 3;
    return scene;
}

bool sun_is_up(const SceneDescription& description) {
    // cosine of 60 degrees: a steeper plane is a wall, as for the default camera
    constexpr double steepest_ground = 0.5;
    if (!description.lamps.empty() && !main_sun(description.lamps)) return false;
    for (const BodyDescription& body : description.bodies) {
        const auto* plane = std::get_if<PlaneShape>(&body.shape);
        if (plane == nullptr || body.type != BodyType::fixed) continue;
        const Vec3 normal = body.rotation * plane->normal.normalized();
        if (normal.y() > steepest_ground && normal.dot(description.light.direction) >= 0.0) return false;
    }
    return true;
}

std::optional<std::size_t> mirror_of(const SceneDescription& description) {
    for (std::size_t i = 0; i < description.bodies.size(); ++i) {
        const BodyDescription& body = description.bodies[i];
        if (endless(body.shape) && body.type == BodyType::fixed && body.appearance.visible &&
            body.appearance.reflection > 0.0)
            return i;
    }
    return std::nullopt;
}

BoundingBall bounding_ball(const RenderBody& proxy, const BodyState& state, const Camera& view) {
    return {view.relative(state.origin) + state.orientation * proxy.bound_center, proxy.bound_radius};
}

float pattern_number(Pattern pattern) {
    switch (pattern) {
        case Pattern::grid:
            return 1.0f;
        case Pattern::checker:
            return 2.0f;
        default:
            return 0.0f;
    }
}

}  // namespace tumble
