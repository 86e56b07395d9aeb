#include "sim/joints/pendulum_rate.h"

#include <algorithm>

namespace tumble {

FreeAxes free_axes(const Joint& joint, const JointGeometry& g) {
    FreeAxes axes;
    if (joint.distance()) return axes;
    axes.count = 0;
    for (std::size_t k = 3; k < 6; ++k)
        if (!joint.locked(k)) axes.axis[std::size_t(axes.count++)] = g.coordinates[k].direction;
    return axes;
}

double pendulum_compliance(const FreeAxes& axes, const Vec3& arm, const Mat3& inverse_inertia) {
    const double lever = arm.norm();
    if (!(lever > 0.0)) return 0.0;
    // Compliance against turns about the joint, times the lever across their axis.
    double gives = 0.0;
    const auto turn_about = [&](const Vec3& axis) {
        gives = std::max(gives, axis.cross(arm).norm() * axis.dot(inverse_inertia * axis));
    };
    if (axes.count == 3) {
        const Vec3 across = arm.unitOrthogonal();
        turn_about(across);
        turn_about(arm.cross(across) / lever);
    } else {
        for (int k = 0; k < axes.count; ++k) turn_about(axes.axis[std::size_t(k)]);
    }
    return gives / 3.0;
}

}  // namespace tumble
