// Binding points of the uniform blocks that all draws share.
#pragma once

#include "render/gl/gl_functions.h"

namespace tumble {

inline constexpr GLuint frame_block = 0, lamp_block = 2;

}  // namespace tumble
