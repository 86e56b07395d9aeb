// Vectors that change with time along keyframes; constant before the first and after the last. Smooth: a cubic Hermite
// spline without overshoot (smooth_slope()), with zero slope at both ends. Linear: constant speed between keys.
#pragma once

#include <Eigen/Core>

#include <algorithm>
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

// Slope of a smooth curve at a key between two segments, from their mean slopes and their lengths (s): that of the
// parabola through the three keys (Catmull-Rom), unless a cubic with it would overshoot. It is limited to the direction
// of both segments and to three times the smaller slope (Fritsch and Carlson 1980, "Monotone piecewise cubic
// interpolation", section 3, along one line): between two equal keys the curve is constant.

template <class Vector>
Vector smooth_slope(const Vector& before, const Vector& after, double span_before, double span_after) {
    Vector slope = (span_after * before + span_before * after) / (span_before + span_after);
    for (const Vector* segment : {&before, &after}) {
        const double along = slope.dot(*segment);
        if (along < 0.0) slope -= along / segment->squaredNorm() * *segment;
    }
    if (slope.dot(before) < 0.0) return 0.0 * slope;
    const double length = slope.norm(), most = 3.0 * std::min(before.norm(), after.norm());
    if (length > most) slope *= most / length;
    return slope;
}

}  // namespace tumble
