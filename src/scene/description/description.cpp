#include "scene/description/description.h"

#include "core/rounding.h"

#include <cmath>

namespace tumble {

std::int64_t FrameTiming::frame_count(double duration) const {
    return std::int64_t(std::floor(rounded_if_nearly_whole(duration * fps))) + 1;
}

}  // namespace tumble
