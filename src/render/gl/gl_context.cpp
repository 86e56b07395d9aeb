#include "render/gl/gl_context.h"

#include "core/available_memory.h"
#include "core/error.h"

#include <GL/gl.h>

#include <string_view>

namespace tumble {
namespace {

/// Mesa 25.1 is the last with OSMesa.
std::unique_ptr<GlContext> make_software_context() {
    try {
        return make_osmesa_context();
    } catch (const MemoryError&) {
        throw;
    } catch (const RunError& no_osmesa) {
        try {
            return make_egl_context(EglDisplayKind::software);
        } catch (const RunError& no_egl) {
            throw RunError(no_osmesa.message() + "\nIn its place " + no_egl.message());
        }
    }
}

}  // namespace

std::unique_ptr<GlContext> make_gl_context(GlBackend backend) {
    std::unique_ptr<GlContext> context = backend == GlBackend::software ? make_software_context()
                                         : backend == GlBackend::osmesa ? make_osmesa_context()
                                                                        : make_egl_context(EglDisplayKind::any);
    context->make_current();
    return context;
}

bool draws_on_cpu(GlBackend backend) {
    if (backend != GlBackend::egl) return true;
    const std::unique_ptr<GlContext> context = make_gl_context(backend);
    const auto get_string = reinterpret_cast<decltype(&glGetString)>(context->get_proc_address("glGetString"));
    if (get_string == nullptr) return false;
    const auto* const renderer = reinterpret_cast<const char*>(get_string(GL_RENDERER));
    return renderer != nullptr && std::string_view(renderer).starts_with("llvmpipe");
}

}  // namespace tumble
