// A point of a body's flight: the input of a law of force. World frame, SI units.
#pragma once

#include "core/vector.h"

namespace tumble {

/// The values on which the forces on a body depend.
struct FlightPoint {
    const Vec3 &position, &velocity, &angular_momentum;
    const Mat3& rotation;
    double elapsed;  // s, since the start of the span
};

}  // namespace tumble
