// An OpenGL context without a window. All drawing goes to framebuffer objects, so a context only has to become current,
// deliver its functions and stay alive; the drawing code is the same for every backend.
#pragma once

#include "render/gl/gl_functions.h"

#include <memory>

namespace tumble {

enum class GlBackend {
    software,  // OSMesa where it is installed, otherwise EGL's software device: the same driver, and the same pixels
    osmesa,
    egl,  // on a graphics card if there is one
};

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

/// True if the backend draws by Mesa's software renderer for CPUs: frames then have the same bytes by every backend.
/// Opens and closes a context. Throws RunError.
bool draws_on_cpu(GlBackend backend);

/// Mesa's off-screen interface: software drawing with no display, no device and no permissions. Throws RunError if the
/// library is missing or cannot make a core context of the requested version.
std::unique_ptr<GlContext> make_osmesa_context();

/// EGL without a surface: the alternative for systems whose Mesa lacks OSMesa, and for graphics cards. Throws RunError
/// if EGL is missing or offers no such display: surfaceless or of any device, or of its software device.
enum class EglDisplayKind { any, software };
std::unique_ptr<GlContext> make_egl_context(EglDisplayKind kind);

}  // namespace tumble
