// An OpenGL context without a window. All drawing goes to framebuffer objects, so a context only has to become current,
// deliver its functions and stay alive; the drawing code is the same for every backend.
#pragma once

#include "render/gl/gl_functions.h"

#include <memory>

namespace tumble {

// The OpenGL backends that a user can choose from.

enum class GlBackend { osmesa, egl };

/// requested version, core profile: textureGather on shadow maps needs 4.0, a base instance 4.2
inline constexpr int gl_major = 4, gl_minor = 2;

class GlContext {
public:
    GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;
    virtual ~GlContext() = default;

    /// Makes the context current in the calling thread. Throws RunError.
    virtual void make_current() = 0;

    /// The address of an OpenGL function, or null.
    virtual void* get_proc_address(const char* name) const = 0;
};

/// Makes a context, current in this thread. Throws RunError that names the missing part and the remedy.
std::unique_ptr<GlContext> make_gl_context(GlBackend backend);

/// Mesa's off-screen interface: software drawing with no display, no device and no permissions. Throws RunError if the
/// library is missing or cannot make a core context of the requested version.
std::unique_ptr<GlContext> make_osmesa_context();

/// EGL without a surface: the alternative for systems whose Mesa lacks OSMesa, and for graphics cards. Throws RunError if
/// EGL is missing or offers neither a surfaceless nor a device display.
std::unique_ptr<GlContext> make_egl_context();

}  // namespace tumble
