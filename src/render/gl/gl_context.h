// A way into OpenGL without a window. Everything is drawn into framebuffers of our own, so a context is only
// made current, asked for its functions, and kept alive; the drawing code is the same for each way in.
#pragma once

#include "render/gl/gl_functions.h"
#include "render/gl/gl_backend.h"

#include <memory>

namespace tumble {

/// The version asked for: core profile, for textureGather on shadow maps (4.0) and instances from a base (4.2).
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

/// Makes a context, current in this thread. Throws RunError saying what is missing and how to get it.
std::unique_ptr<GlContext> make_gl_context(GlBackend backend);

}  // namespace tumble
