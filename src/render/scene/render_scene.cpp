#include "render/scene/render_scene.h"

#include "render/scene/large_receivers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

// AO radius of a body, in parts of its median half edge; for a plate or rod at most twice its short half edge.
constexpr double ao_radius_of_half_edge = 1.0;
constexpr double ao_radius_of_thin_side = 2.0;

// Width of a box's rounded edge, in parts of its shortest edge: 3 cm for a box of 1 m.
constexpr double bevel_of_edge = 0.03;

// A body's pattern has four cells across its thinnest side.
constexpr double pattern_cell_of_radius = 0.5;

double ao_radius_of(const Vec3& half_size) {
    std::array<double, 3> h = {half_size.x(), half_size.y(), half_size.z()};
    std::sort(h.begin(), h.end());
    return std::min(ao_radius_of_half_edge * h[1], ao_radius_of_thin_side * h[0]);
}

RenderMesh make_render_mesh(const std::shared_ptr<const MeshAsset>& asset) {
    RenderMesh proxy;
    proxy.asset = asset;
    const Closedness form = closedness(asset->mesh);
    proxy.closed = form.closed() && form.signed_volume > 0.0;
    Bounds bounds;
    for (const MeshAsset::Vertex& v : asset->vertices) bounds.add(Vec3(v.position[0], v.position[1], v.position[2]));
    proxy.bound_center = bounds.center();
    proxy.half_extent = 0.5 * bounds.extent();
    return proxy;
}

void set_shape(RenderBody& proxy, const PlaneShape& plane, RenderScene&) {
    proxy.kind = DrawKind::plane;
    proxy.plane = plane;
}

void set_shape(RenderBody& proxy, const BoxShape& box, RenderScene&) {
    proxy.kind = DrawKind::box;
    proxy.half_size = 0.5 * box.size;
    proxy.bound_radius = proxy.half_size.norm();
    proxy.ao_radius = ao_radius_of(proxy.half_size);
    proxy.bevel = bevel_of_edge * box.size.minCoeff();
    proxy.pattern_cell = pattern_cell_of_radius * proxy.half_size.minCoeff();
}

void set_shape(RenderBody& proxy, const SphereShape& sphere, RenderScene&) {
    proxy.kind = DrawKind::ball;
    proxy.half_size = Vec3::Constant(sphere.radius);
    proxy.pattern_cell = pattern_cell_of_radius * sphere.radius;
    proxy.bound_radius = sphere.radius;
    proxy.ao_radius = ao_radius_of(proxy.half_size);
}

void set_shape(RenderBody& proxy, const MeshShape& mesh, RenderScene& scene) {
    const std::shared_ptr<const MeshAsset>& asset = mesh.asset;
    if (asset == nullptr || asset->vertices.empty() || asset->indices.empty()) return;
    proxy.kind = DrawKind::mesh;
    const auto known = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                    [&](const RenderMesh& other) { return other.asset == asset; });
    proxy.mesh = std::size_t(known - scene.meshes.begin());
    if (known == scene.meshes.end()) scene.meshes.push_back(make_render_mesh(asset));
    const RenderMesh& shared = scene.meshes[proxy.mesh];
    proxy.bound_center = shared.bound_center;
    proxy.bound_radius = shared.half_extent.norm();
    proxy.ao_radius =
        std::max(ao_radius_of(shared.half_extent), 1e-3 * proxy.bound_radius);  // a flat mesh has no thickness
    proxy.pattern_cell = pattern_cell_of_radius * proxy.ao_radius;
}

void set_shape(RenderBody&, const CompoundShape&, RenderScene&) {}  // expanded by compound_expansion.h

}  // namespace

RenderScene describe_bodies(const SceneDescription& description) {
    RenderScene scene;
    scene.light = description.light;
    scene.sun_up = sun_is_up(description);
    scene.cords = description.cords;
    for (const BodyDescription& body : description.bodies) {
        RenderBody proxy;
        proxy.fixed = body.type == BodyType::fixed;
        if (body.appearance.visible) {
            std::visit([&](const auto& shape) { set_shape(proxy, shape, scene); }, body.shape);
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
