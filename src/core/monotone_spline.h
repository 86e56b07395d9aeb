// The slope of a smooth path at a key between two segments, from their mean slopes and their spans (s): that of the parabola through
// the three keys (Catmull-Rom), unless a cubic with it would overshoot. It goes back along neither segment, and is no more than three
// times the lesser (Fritsch and Carlson 1980, "Monotone piecewise cubic interpolation", section 3, along one line): between two equal
// keys nothing moves.
#pragma once

#include <algorithm>

namespace tumble {

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
