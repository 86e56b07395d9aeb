#include "sim/geometry/shapes/shape.h"

#include <algorithm>

namespace tumble {
namespace {

double farthest_point(const Compound::Part& part) {
    if (const auto* curved = std::get_if<std::shared_ptr<const CurvedBody>>(&part.collider))
        return (*curved)->farthest_from(part.place.to_body(Vec3::Zero()));
    const RoundedHull hull = rounded_hull(part.collider);
    double farthest = 0.0;
    for (const Vec3& v : hull.points) farthest = std::max(farthest, part.place.to_world(v).norm());
    return farthest + hull.radius;
}

}  // namespace

void Compound::complete() {
    std::vector<Bounds> bounds;
    radius = 0.0;
    inner_radius = infinity;
    for (Part& part : parts) {
        part.reach = tumble::bounding_radius(part.collider);
        radius = std::max(radius, farthest_point(part));
        inner_radius = std::min(inner_radius, tumble::depth(part.collider));
        bounds.push_back(tumble::world_bounds(part.collider, part.place));
    }
    tree = BoundsTree(std::move(bounds));
}

/// As if no part sheltered another from the wind.
double Compound::mean_projected_area() const {
    double sum = 0.0;
    for (const Part& part : parts) sum += tumble::mean_projected_area(part.collider);
    return sum;
}

void visit_extent(const CompoundShape& compound, const ExtentVisitor& visit) {
    for (const CompoundPart& part : *compound.parts)
        visit_extent(part.shape, [&](const Vec3& p, double r) { visit(part.position + part.rotation * p, r); });
}

MassProperties mass_properties(const CompoundShape& compound, double density) {
    std::vector<MassProperties> parts;
    for (const CompoundPart& part : *compound.parts)
        parts.push_back(
            placed(mass_properties(part.shape, part.density.value_or(density)), part.position, part.rotation));
    return sum_of_masses(parts);
}

double first_hit(const CompoundShape& compound, const Vec3& from, const Vec3& direction) {
    double nearest = infinity;
    for (const CompoundPart& part : *compound.parts) {
        const Quat back = part.rotation.conjugate();
        nearest = std::min(nearest, first_hit(part.shape, back * (from - part.position), back * direction));
    }
    return nearest;
}

CollisionShape make_collider(const CompoundShape& compound, const ColliderRequest& request, ColliderCache& cache) {
    ColliderCache::Whole& known = cache.compounds[compound.parts.get()];
    // Another density may move the center of mass.
    if (known.made && known.origin == request.origin) return known.made;
    auto made = std::make_shared<Compound>();
    for (const CompoundPart& part : *compound.parts) {
        if (!part.collide) continue;
        const Vec3 middle = mass_properties(part.shape, request.density).center_of_mass;
        made->parts.push_back(
            {make_collider(part.shape, {false, middle, request.density}, cache),
             {part.position + part.rotation * middle - request.origin, part.rotation.toRotationMatrix()}});
    }
    made->complete();
    known = {request.origin, std::move(made)};
    return known.made;
}

}  // namespace tumble
