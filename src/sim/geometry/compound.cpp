#include "sim/geometry/compound.h"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

double farthest_point(const Compound::Part& part) {
    if (const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&part.collider)) {
        double farthest = 0.0;
        for (const Vec3& v : (*hull)->vertices) farthest = std::max(farthest, part.place.to_world(v).norm());
        return farthest;
    }
    return part.place.position.norm() + part.reach;
}

}  // namespace

void Compound::complete() {
    std::vector<Bounds> bounds;
    radius = 0.0;
    inner_radius = std::numeric_limits<double>::infinity();
    for (Part& part : parts) {
        part.reach = bounding_radius(part.collider);
        radius = std::max(radius, farthest_point(part));
        inner_radius = std::min(inner_radius, depth(part.collider));
        bounds.push_back(world_bounds(part.collider, part.place));
    }
    tree = BoundsTree(std::move(bounds));
}

}  // namespace tumble
