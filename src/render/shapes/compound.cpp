#include "render/shapes/drawn_shape.h"

#include <algorithm>

namespace tumble {

double reach(const CompoundShape& compound) {
    double radius = 0.0;
    for (const CompoundPart& part : *compound.parts)
        radius =
            std::max(radius, part.position.norm() + std::visit([](const auto& one) { return reach(one); }, part.shape));
    return radius;
}

// Drawn part by part: compound_expansion.h and shape_instance.h.
void set_proxy(RenderBody&, const CompoundShape&, std::vector<RenderMesh>&) {}
bool closed(const CompoundShape&) { return true; }
std::vector<SurfaceCorner> surface_triangles(const CompoundShape&) { return {}; }
void cast_rays(const CompoundShape&, const PartPlace&, RayTarget&) {}
Vec3 surface_normal(const CompoundShape&, const PartPlace&, std::uint32_t, const Vec3&, double) { return Vec3::Zero(); }

}  // namespace tumble
