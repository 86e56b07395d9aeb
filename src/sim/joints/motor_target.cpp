#include "sim/joints/motor_target.h"

#include "core/monotone_spline.h"

#include <Eigen/Core>

#include <algorithm>

namespace tumble {
namespace {

// Tangent at a key; zero at both ends, because the target stands still outside of the keys.
double slope_at(const std::vector<JointTarget>& keys, std::size_t i) {
    if (i == 0 || i + 1 == keys.size()) return 0.0;
    using Slope = Eigen::Matrix<double, 1, 1>;
    const double before = keys[i].time - keys[i - 1].time, after = keys[i + 1].time - keys[i].time;
    return smooth_slope<Slope>(Slope((keys[i].value - keys[i - 1].value) / before),
                               Slope((keys[i + 1].value - keys[i].value) / after), before, after)[0];
}

}  // namespace

double motor_target(const JointMotor& motor, double time) {
    const std::vector<JointTarget>& keys = motor.targets;
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), time, [](double t, const JointTarget& key) { return t < key.time; });
    if (next == keys.begin()) return next->value;
    if (next == keys.end()) return keys.back().value;
    const JointTarget& last = next[-1];
    const double span = next->time - last.time, u = (time - last.time) / span, change = next->value - last.value;
    if (motor.interpolation == Interpolation::linear) return last.value + change * u;
    // Hermite basis.
    const double h1 = u * u * (3.0 - 2.0 * u), h2 = u * (1.0 - u) * (1.0 - u), h3 = -u * u * (1.0 - u);
    const auto i = std::size_t(next - keys.begin());
    return last.value + h1 * change + span * (h2 * slope_at(keys, i - 1) + h3 * slope_at(keys, i));
}

}  // namespace tumble
