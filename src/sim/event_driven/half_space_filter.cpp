#include "sim/event_driven/half_space_filter.h"

#include "sim/geometry/settings.h"

namespace tumble {

bool HalfSpaceFilter::stays_below(const Trajectory& path, double radius, double from, double horizon) const {
    if (!path.parabolic()) return false;
    const double height = normal.dot(path.position(from)) - offset - radius;
    const double rate = normal.dot(path.velocity(from)), acceleration = normal.dot(path.acceleration(from));
    if (!(height > tuning::touch * radius)) return false;
    if (acceleration > 0.0) return rate >= 0.0;
    return height + horizon * (rate + 0.5 * horizon * acceleration) > 0.0;
}

}  // namespace tumble
