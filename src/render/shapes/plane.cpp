#include "render/shapes/drawn_shape.h"

#include <array>

namespace tumble {

void set_proxy(RenderBody& proxy, const PlaneShape& plane, std::vector<RenderMesh>&) {
    proxy.kind = DrawKind::plane;
    proxy.plane = plane;
}

double reach(const PlaneShape&) { return infinity; }

bool closed(const PlaneShape&) { return true; }

std::vector<SurfaceCorner> surface_triangles(const PlaneShape&) { return {}; }

void cast_rays(const PlaneShape& plane, const PartPlace& place, RayTarget& target) {
    const Vec3 normal = place.axes * plane.normal;
    const double height = -normal.dot(place.origin) - plane.offset;
    // A plane has no corners; its bounds are the whole image, as for a hull that contains the eye.
    const std::array<Vec3, 2> everywhere = {Vec3(0.0, 0.0, 1.0), Vec3(0.0, 0.0, -1.0)};
    target.add_rows(everywhere,
                    [&](const RayRow& rays, double* depths) { plane_depths(normal, height, rays, depths); });
}

Vec3 surface_normal(const PlaneShape& plane, const PartPlace&, std::uint32_t, const Vec3&, double) {
    return plane.normal;
}

}  // namespace tumble
