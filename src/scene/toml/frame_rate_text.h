// A frame rate as it is given: a number, or a fraction of two whole numbers.
#pragma once

#include "scene/toml/source_position.h"

#include <string_view>

namespace tumble {

/// "60", "29.97" or "24000/1001" to frames per second. Fails at the position for another text and outside of the
/// limits.
double read_frame_rate(std::string_view text, const SourcePosition& origin);

/// The same of a fraction alone: a scene file gives numbers without quotes.
double read_rate_fraction(std::string_view text, const SourcePosition& origin);

}  // namespace tumble
