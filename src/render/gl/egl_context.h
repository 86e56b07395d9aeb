// EGL without a surface: the second way in, for systems whose Mesa no longer ships OSMesa, and for graphics cards.
#pragma once

#include "render/gl/gl_context.h"

namespace tumble {

/// Throws RunError when EGL is missing or offers neither a surfaceless nor a device display.
std::unique_ptr<GlContext> make_egl_context();

}  // namespace tumble
