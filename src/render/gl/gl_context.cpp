#include "render/gl/gl_context.h"

namespace tumble {

std::unique_ptr<GlContext> make_gl_context(GlBackend backend) {
    std::unique_ptr<GlContext> context;
    if (backend == GlBackend::egl) {
        context = make_egl_context();
    } else {
        context = make_osmesa_context();
    }
    context->make_current();
    return context;
}

}  // namespace tumble
