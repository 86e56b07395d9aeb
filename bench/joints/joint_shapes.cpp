#include "joints/joint_shapes.h"

namespace tumble::bench {
namespace {

Joint joint_of(JointKind kind, std::size_t first, std::size_t second, const Vector& anchor) {
    Joint joint;
    joint.kind = kind;
    joint.first = first;
    joint.second = second;
    joint.anchor = anchor;
    return joint;
}

// With the horizontal force `pull` and the vertical force at the first end, the slope of a link is that of the mean
// force of its ends: the moments about its center vanish.
HangingChain shape_under(const std::vector<double>& masses, double link, double pull) {
    double above = 0.0;
    for (const double m : masses) above += 0.5 * m * g;
    HangingChain chain;
    Vector at;
    chain.joints.push_back(at);
    for (const double m : masses) {
        const double slope = (0.5 * m * g - above) / pull, length = std::hypot(1.0, slope);
        above -= m * g;
        chain.directions.push_back({1.0 / length, 0.0, slope / length});
        at = at + link * chain.directions.back();
        chain.joints.push_back(at);
    }
    return chain;
}

}  // namespace

Joint ball_joint(std::size_t first, std::size_t second, const Vector& anchor) {
    return joint_of(JointKind::ball, first, second, anchor);
}
Joint hinge_joint(std::size_t first, std::size_t second, const Vector& anchor, const Vector& axis) {
    Joint joint = joint_of(JointKind::hinge, first, second, anchor);
    joint.axis = axis;
    return joint;
}
Joint fixed_joint(std::size_t first, std::size_t second, const Vector& anchor) {
    return joint_of(JointKind::fixed, first, second, anchor);
}

Orientation along(const Vector& direction) { return turn({0.0, 1.0, 0.0}, -std::atan2(direction.z, direction.x)); }

HangingChain hanging(const std::vector<double>& masses, double link, double span) {
    double low = 1e-6, high = 1e9;  // N; the span grows with the pull
    for (int i = 0; i < 200; ++i) {
        const double middle = std::sqrt(low * high);
        (shape_under(masses, link, middle).joints.back().x < span ? low : high) = middle;
    }
    return shape_under(masses, link, std::sqrt(low * high));
}

}  // namespace tumble::bench
