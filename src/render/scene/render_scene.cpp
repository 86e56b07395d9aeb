#include "render/scene/render_scene.h"

#include "render/scene/large_receivers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

// AO radius of a body, in parts of its median half edge; for a plate or rod at most twice its short half edge.
constexpr double reach_of_half_edge = 1.0;
constexpr double reach_of_thin_side = 2.0;

// Width of a box's rounded edge, in parts of its shortest edge: 3 cm for a box of 1 m.
constexpr double bevel_of_edge = 0.03;

// A body's pattern has four cells across its thinnest side.
constexpr double pattern_cell_of_radius = 0.5;

double reach_of(const Vec3& half_size) {
    std::array<double, 3> h = {half_size.x(), half_size.y(), half_size.z()};
    std::sort(h.begin(), h.end());
    return std::min(reach_of_half_edge * h[1], reach_of_thin_side * h[0]);
}

RenderMesh make_mesh_look(const MeshAsset& asset) {
    RenderMesh look;
    look.asset = &asset;
    const Closedness form = closedness(asset.mesh);
    look.closed = form.closed() && form.signed_volume > 0.0;
    Bounds bounds;
    for (const MeshAsset::Vertex& v : asset.vertices) bounds.add(Vec3(v.position[0], v.position[1], v.position[2]));
    look.bound_center = bounds.center();
    look.half_extent = 0.5 * bounds.extent();
    return look;
}

void set_shape(RenderBody& look, const PlaneShape& plane, RenderScene&) {
    look.kind = DrawKind::plane;
    look.plane = plane;
}

void set_shape(RenderBody& look, const BoxShape& box, RenderScene&) {
    look.kind = DrawKind::box;
    look.half_size = 0.5 * box.size;
    look.bound_radius = look.half_size.norm();
    look.reach = reach_of(look.half_size);
    look.bevel = bevel_of_edge * box.size.minCoeff();
    look.pattern_cell = pattern_cell_of_radius * look.half_size.minCoeff();
}

void set_shape(RenderBody& look, const SphereShape& sphere, RenderScene&) {
    look.kind = DrawKind::ball;
    look.half_size = Vec3::Constant(sphere.radius);
    look.pattern_cell = pattern_cell_of_radius * sphere.radius;
    look.bound_radius = sphere.radius;
    look.reach = reach_of(look.half_size);
}

void set_shape(RenderBody& look, const MeshShape& mesh, RenderScene& looks) {
    const MeshAsset* asset = mesh.asset.get();
    if (asset == nullptr || asset->vertices.empty() || asset->indices.empty()) return;
    look.kind = DrawKind::mesh;
    const auto known = std::find_if(looks.meshes.begin(), looks.meshes.end(),
                                    [&](const RenderMesh& other) { return other.asset == asset; });
    look.mesh = std::size_t(known - looks.meshes.begin());
    if (known == looks.meshes.end()) looks.meshes.push_back(make_mesh_look(*asset));
    const RenderMesh& shared = looks.meshes[look.mesh];
    look.bound_center = shared.bound_center;
    look.bound_radius = shared.half_extent.norm();
    look.reach = std::max(reach_of(shared.half_extent), 1e-3 * look.bound_radius);  // a flat mesh has no thickness
    look.pattern_cell = pattern_cell_of_radius * look.reach;
}

void set_shape(RenderBody&, const CompoundShape&, RenderScene&) {}  // expanded by compound_expansion.h

}  // namespace

RenderScene describe_bodies(const SceneDescription& scene) {
    RenderScene looks;
    for (const BodyDescription& body : scene.bodies) {
        RenderBody look;
        look.fixed = body.type == BodyType::fixed;
        if (body.appearance.visible) {
            std::visit([&](const auto& shape) { set_shape(look, shape, looks); }, body.shape);
            const std::array<double, 3> linear = to_linear(body.appearance.color);
            look.color = {float(linear[0]), float(linear[1]), float(linear[2])};
            look.roughness = float(body.appearance.roughness);
            look.metallic = float(body.appearance.metallic);
            look.pattern = body.appearance.pattern;
        }
        if (look.kind == DrawKind::plane) looks.planes.push_back(looks.bodies.size());
        looks.bodies.push_back(look);
    }
    find_large_receivers(scene, looks);
    std::vector<double> reaches;
    for (const RenderBody& look : looks.bodies)
        if (look.reach > 0.0 && !look.ground) reaches.push_back(look.reach);
    if (!reaches.empty()) {
        const auto middle = reaches.begin() + std::ptrdiff_t(reaches.size() / 2);
        std::nth_element(reaches.begin(), middle, reaches.end());
        looks.typical_reach = *middle;
    }
    for (const RenderBody& look : looks.bodies)
        if (look.kind == DrawKind::mesh) looks.mesh_triangles += looks.meshes[look.mesh].asset->indices.size() / 3;
    return looks;
}

BoundingBall bounding_ball(const RenderBody& look, const BodyState& state, const Camera& view) {
    return {view.relative(state.origin) + state.orientation * look.bound_center, look.bound_radius};
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
