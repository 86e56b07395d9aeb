// Places in a frame for pictures that are laid over it.
#pragma once

#include <cstdint>

namespace tumble {

enum class FrameCorner : std::uint8_t { top_left, top_right, bottom_left, bottom_right };

}  // namespace tumble
