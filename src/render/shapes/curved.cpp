#include "sim/geometry/shapes/curved.h"
#include "render/shapes/drawn_shape.h"

namespace tumble {

void set_proxy(RenderBody& proxy, const CurvedShape& shape, std::vector<RenderMesh>& meshes) {
    set_proxy(proxy, MeshShape{shape.drawn}, meshes);
}

double reach(const CurvedShape& shape) { return reach(MeshShape{shape.drawn}); }

bool closed(const CurvedShape&) { return true; }

std::vector<SurfaceCorner> surface_triangles(const CurvedShape& shape) {
    return surface_triangles(MeshShape{shape.drawn});
}

// The true surface, not the triangles.
void cast_rays(const CurvedShape& shape, const PartPlace& place, RayTarget& target) {
    const Mat3 back = place.axes.transpose();
    const Vec3 eye = back * -place.origin;
    std::vector<Vec3> hull;
    visit_extent(shape, [&](const Vec3& center, double radius) {
        for (const Vec3& corner : corners_of({place.axes, place.origin + place.axes * center}, Vec3::Constant(radius)))
            hull.push_back(corner);
    });
    target.add_rows(hull, [&](const RayRow& rays, double* depths) {
        for (std::size_t i = 0; i < rays.count; ++i)
            depths[i] = first_hit(shape, eye, back * Vec3(rays.x[i], rays.y, 1.0));
    });
}

Vec3 surface_normal(const CurvedShape& shape, const PartPlace& place, std::uint32_t, const Vec3& ray, double depth) {
    return normal_at(shape, place.axes.transpose() * (depth * ray - place.origin));
}

}  // namespace tumble
