// Numbers of one kind that change with time along keyframes: still before the first and after the last. Smooth: a cubic Hermite
// spline that overshoots nothing (smooth_slope.h), at rest at both ends. Linear: an even speed from key to key.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace tumble {

class KeyframeCurve {
public:
    /// Times increase; there is at least one, and as many values, all of one length.
    KeyframeCurve(std::vector<double> times, std::vector<Eigen::VectorXd> values, bool smooth);

    Eigen::VectorXd at(double time) const;

private:
    std::vector<double> times_;             // s
    std::vector<Eigen::VectorXd> values_;
    std::vector<Eigen::VectorXd> slopes_;   // at the keys, 1/s
    bool smooth_;
};

}  // namespace tumble
