#include "render/scene/render_scene.h"

#include "render/scene/large_receivers.h"
#include "render/shapes/drawn_shape.h"

#include <algorithm>
#include <array>

namespace tumble {

RenderScene describe_bodies(const SceneDescription& description) {
    RenderScene scene;
    scene.light = description.light;
    scene.sun_up = sun_is_up(description);
    scene.cords = description.cords;
    for (const BodyDescription& body : description.bodies) {
        RenderBody proxy;
        proxy.fixed = body.type == BodyType::fixed;
        if (body.appearance.visible) {
            std::visit([&](const auto& shape) { set_proxy(proxy, shape, scene.meshes); }, body.shape);
            const std::array<double, 3> linear = to_linear(body.appearance.color);
            proxy.color = {float(linear[0]), float(linear[1]), float(linear[2])};
            proxy.roughness = float(body.appearance.roughness);
            proxy.metallic = float(body.appearance.metallic);
            proxy.pattern = body.appearance.pattern;
        }
        if (proxy.kind == DrawKind::plane) scene.planes.push_back(scene.bodies.size());
        scene.bodies.push_back(proxy);
    }
    find_large_receivers(description, scene);
    std::vector<double> ao_radii;
    for (const RenderBody& proxy : scene.bodies)
        if (proxy.ao_radius > 0.0 && !proxy.large_receiver) ao_radii.push_back(proxy.ao_radius);
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
    for (const BodyDescription& body : description.bodies) {
        const auto* plane = std::get_if<PlaneShape>(&body.shape);
        if (plane == nullptr || body.type != BodyType::fixed) continue;
        const Vec3 normal = body.rotation * plane->normal.normalized();
        if (normal.y() > steepest_ground && normal.dot(description.light.direction) >= 0.0) return false;
    }
    return true;
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
