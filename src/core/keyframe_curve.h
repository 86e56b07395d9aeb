// Vectors that change with time along keyframes; constant before the first and after the last. Smooth: a cubic Hermite
// spline without overshoot (monotone_spline.h), with zero slope at both ends. Linear: constant speed between keys.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace tumble {

class KeyframeCurve {
public:
    /// Precondition: times increase; there is at least one, and one value per time, all of one length.
    KeyframeCurve(std::vector<double> times, std::vector<Eigen::VectorXd> values, bool smooth);

    Eigen::VectorXd at(double time) const;

private:
    std::vector<double> times_;  // s
    std::vector<Eigen::VectorXd> values_;
    std::vector<Eigen::VectorXd> slopes_;  // at the keys, 1/s
    bool smooth_;
};

}  // namespace tumble
