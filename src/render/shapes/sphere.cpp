#include "render/shapes/drawing_style.h"
#include "render/shapes/drawn_shape.h"
#include "render/shapes/primitive_meshes.h"

namespace tumble {
namespace {

constexpr int ball_level = 3;  // 1280 triangles: smooth as a ghost of any size

}  // namespace

void set_proxy(RenderBody& proxy, const SphereShape& sphere, std::vector<RenderMesh>&) {
    proxy.kind = DrawKind::ball;
    proxy.half_size = proxy.half_extent = Vec3::Constant(sphere.radius);
    proxy.pattern_cell = style::pattern_cell_of_radius * sphere.radius;
    proxy.bound_radius = sphere.radius;
    proxy.ao_radius = ao_radius_of(proxy.half_size);
}

double reach(const SphereShape& ball) { return ball.radius; }

bool closed(const SphereShape&) { return true; }

std::vector<SurfaceCorner> surface_triangles(const SphereShape& ball) {
    static const DrawMesh unit = make_ball(ball_level);
    std::vector<SurfaceCorner> corners;
    for (const std::uint32_t index : unit.indices) {
        const MeshAsset::Vertex& v = unit.vertices[index];
        corners.push_back({ball.radius * Vec3(v.position[0], v.position[1], v.position[2]),
                           Vec3(v.normal[0], v.normal[1], v.normal[2])});
    }
    return corners;
}

void cast_rays(const SphereShape& ball, const PartPlace& place, RayTarget& target) {
    target.add_rows(corners_of({Mat3::Identity(), place.origin}, Vec3::Constant(ball.radius)),
                    [&](const RayRow& rays, double* depths) { ball_depths(place.origin, ball.radius, rays, depths); });
}

Vec3 surface_normal(const SphereShape&, const PartPlace& place, std::uint32_t, const Vec3& ray, double depth) {
    return (place.axes.transpose() * (depth * ray - place.origin)).normalized();
}

}  // namespace tumble
