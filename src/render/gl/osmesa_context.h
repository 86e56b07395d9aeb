// Mesa's off-screen interface: software drawing with no display, no device and no permissions.
#pragma once

#include "render/gl/gl_context.h"

namespace tumble {

/// Throws RunError if the library is missing or cannot make a core context of the requested version.
std::unique_ptr<GlContext> make_osmesa_context();

}  // namespace tumble
