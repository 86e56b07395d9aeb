#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <cmath>

namespace tumble {

Polyhedron make_box(const Vec3& size) {
    Polyhedron p;
    const Vec3 h = 0.5 * size;
    // Vertex i has the signs of i's bits: bit 0 x, bit 1 y, bit 2 z.
    for (int i = 0; i < 8; ++i)
        p.vertices.emplace_back(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z());
    const std::uint32_t loops[6][4] = {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3},
                                       {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}};
    for (const auto& loop : loops) p.faces.push_back({Vec3::Zero(), 0.0, {loop, loop + 4}});
    p.complete();
    for (int f = 0; f < 6; ++f) {  // exact planes: no rounding from the normalization
        p.faces[f].normal = Vec3::Unit(f / 2) * (f % 2 ? -1.0 : 1.0);
        p.faces[f].offset = h[f / 2];
    }
    p.is_box = true;
    p.half_extent = h;
    return p;
}

/// The slabs of Kay and Kajiya 1986.
double box_entry(const Vec3& half_size, const Vec3& from, const Vec3& direction) {
    double enter = -infinity, leave = infinity;
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0.0) {
            if (std::fabs(from[k]) > half_size[k]) return infinity;
            continue;
        }
        const double a = (-half_size[k] - from[k]) / direction[k], b = (half_size[k] - from[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave && leave > 0.0 ? std::max(enter, 0.0) : infinity;
}

void visit_extent(const BoxShape& box, const ExtentVisitor& visit) {
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
        visit(sign.cwiseProduct(box.size), 0.0);
    }
}

MassProperties mass_properties(const BoxShape& box, double density) {
    MassProperties p;
    p.mass = density * box.size.x() * box.size.y() * box.size.z();
    const Vec3 s = box.size.cwiseProduct(box.size);
    p.inertia.diagonal() = p.mass / 12.0 * Vec3(s.y() + s.z(), s.z() + s.x(), s.x() + s.y());
    return p;
}

double first_hit(const BoxShape& box, const Vec3& from, const Vec3& direction) {
    return box_entry(0.5 * box.size, from, direction);
}

BoxShape enlarged(const BoxShape& box, double factor) { return {box.size * factor}; }

CollisionShape make_collider(const BoxShape& box, const ColliderRequest&, ColliderCache& cache) {
    auto& made = cache.boxes[{box.size.x(), box.size.y(), box.size.z()}];
    if (!made) made = std::make_shared<const Polyhedron>(make_box(box.size));
    return made;
}

}  // namespace tumble
