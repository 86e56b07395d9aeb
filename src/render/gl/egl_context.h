// EGL without a surface: the alternative for systems whose Mesa lacks OSMesa, and for graphics cards.
#pragma once

#include "render/gl/gl_context.h"

namespace tumble {

/// Throws RunError if EGL is missing or offers neither a surfaceless nor a device display.
std::unique_ptr<GlContext> make_egl_context();

}  // namespace tumble
