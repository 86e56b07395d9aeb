#include "scene/description.h"

#include <algorithm>
#include <cmath>

namespace tumble {

std::int64_t SceneDescription::frame_count() const {
    // 4.35 * 100 is 434.99999999999994: a product within a few roundings of a whole number means that number.
    constexpr double rounding = 1e-12;   // relative; about 4500 units in the last place
    const double product = simulation.duration * output.fps;
    const double nearest = std::nearbyint(product);
    const bool whole = std::fabs(product - nearest) <= rounding * std::max(1.0, product);
    return static_cast<std::int64_t>(whole ? nearest : std::floor(product)) + 1;
}

}  // namespace tumble
