#include "app/timing/motion_blur.h"

#include <algorithm>
#include <cmath>

namespace tumble {

Shutter Shutter::of(double degrees, int samples) {
    if (degrees <= 0.0 || samples <= 1) return {};
    return {std::max(samples, int(std::lround(360.0 / degrees * samples))), samples};
}

}  // namespace tumble
