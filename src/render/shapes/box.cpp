#include "render/shapes/drawn_shape.h"

#include "render/shapes/drawing_style.h"

#include <utility>

namespace tumble {

void set_proxy(RenderBody& proxy, const BoxShape& box, std::vector<RenderMesh>&) {
    proxy.kind = DrawKind::box;
    proxy.half_size = proxy.half_extent = 0.5 * box.size;
    proxy.bound_radius = proxy.half_size.norm();
    proxy.ao_radius = ao_radius_of(proxy.half_size);
    proxy.bevel = style::bevel_of_edge * box.size.minCoeff();
    proxy.pattern_cell = style::pattern_cell_of_radius * proxy.half_size.minCoeff();
}

double reach(const BoxShape& box) { return 0.5 * box.size.norm(); }

bool closed(const BoxShape&) { return true; }

std::vector<SurfaceCorner> surface_triangles(const BoxShape& box) {
    const Vec3 half = 0.5 * box.size;
    std::vector<SurfaceCorner> corners;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 normal = Vec3::Zero(), u = Vec3::Zero(), v = Vec3::Zero();
            normal[axis] = side;
            u[(axis + 1) % 3] = half[(axis + 1) % 3];
            v[(axis + 2) % 3] = half[(axis + 2) % 3];
            const Vec3 center = side * half[axis] * Vec3::Unit(axis);
            for (const auto& [s, t] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, -1),
                                       std::pair(1, 1), std::pair(-1, 1)})
                corners.push_back({center + s * u + t * v, normal});
        }
    return corners;
}

void cast_rays(const BoxShape& box, const PartPlace& place, RayTarget& target) {
    const Vec3 half_size = 0.5 * box.size;
    target.add_rows(corners_of(place, half_size),
                    [&](const RayRow& rays, double* depths) { box_depths(place, half_size, rays, depths); });
}

/// Normal of the face through which the ray enters: the one whose plane it crosses last.
Vec3 surface_normal(const BoxShape& box, const PartPlace& place, std::uint32_t, const Vec3& ray, double) {
    int last = 0;
    double last_depth = -infinity, side = 1.0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = place.axes.col(k);
        const double along = axis.dot(ray);
        if (along == 0.0) continue;
        const double towards_eye = along > 0.0 ? -1.0 : 1.0;
        const double depth = (axis.dot(place.origin) + towards_eye * 0.5 * box.size[k]) / along;
        if (!(depth > last_depth)) continue;
        last = k;
        last_depth = depth;
        side = towards_eye;
    }
    return side * Vec3::Unit(last);
}

}  // namespace tumble
