// The OpenGL backends that a user can choose from.
#pragma once

namespace tumble {

enum class GlBackend { osmesa, egl };

}  // namespace tumble
