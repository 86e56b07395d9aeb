#include "sim/geometry/shapes/shape.h"

#include <cmath>

namespace tumble {

void visit_extent(const SphereShape& ball, const ExtentVisitor& visit) { visit(Vec3::Zero(), ball.radius); }

MassProperties mass_properties(const SphereShape& ball, double density) {
    MassProperties p;
    p.mass = density * 4.0 / 3.0 * pi * ball.radius * ball.radius * ball.radius;
    p.inertia.diagonal().setConstant(0.4 * p.mass * ball.radius * ball.radius);
    return p;
}

double first_hit(const SphereShape& ball, const Vec3& from, const Vec3& direction) {
    const double a = direction.squaredNorm(), b = from.dot(direction),
                 c = from.squaredNorm() - ball.radius * ball.radius;
    const double root = b * b - a * c;
    if (root < 0.0) return infinity;
    const double enter = (-b - std::sqrt(root)) / a;
    return enter > 0.0 ? enter : infinity;
}

SphereShape enlarged(const SphereShape& ball, double factor) { return {ball.radius * factor}; }

CollisionShape make_collider(const SphereShape& ball, const ColliderRequest&, ColliderCache&) {
    return Ball{ball.radius};
}

}  // namespace tumble
