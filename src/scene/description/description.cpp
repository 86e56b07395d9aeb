#include "scene/description/description.h"

#include "core/rounding.h"

#include <cmath>

namespace tumble {

std::int64_t SceneDescription::frame_count() const {
    return std::int64_t(std::floor(whole_where_meant(simulation.duration * output.fps))) + 1;
}

}  // namespace tumble
