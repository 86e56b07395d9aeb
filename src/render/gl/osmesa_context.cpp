#include "render/gl/gl_context.h"

#include "core/available_memory.h"
#include "core/dynamic_library.h"
#include "core/error.h"

#if __has_include(<GL/osmesa.h>)
#include <GL/osmesa.h>
#include <fmt/format.h>

#include <array>

namespace tumble {
namespace {

constexpr std::array osmesa_library_names = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};

// OSMesa requires a default framebuffer in the caller's memory; it is never drawn to.
constexpr int default_framebuffer_size = 4;  // pixels

class OsmesaContext final : public GlContext {
public:
    OsmesaContext()
        : library_(osmesa_library_names, "the rendering library", "libosmesa6"),
          destroy_(library_.require<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")),
          make_current_(library_.require<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent")),
          get_proc_address_(library_.require<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress")) {
        const auto create = library_.require<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  gl_major,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  gl_minor,
                                  0};
        context_ = create(attributes, nullptr);
        if (context_ == nullptr)
            throw RunError(fmt::format("OSMesa cannot make an OpenGL {}.{} core context; Mesa 20 or later is needed{}",
                                       gl_major, gl_minor, memory_limit_note()));
    }

    ~OsmesaContext() override { destroy_(context_); }

    void make_current() override {
        if (!make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, default_framebuffer_size,
                           default_framebuffer_size))
            throw RunError("OSMesa cannot make its context current");
    }

    void* get_proc_address(const char* name) const override { return reinterpret_cast<void*>(get_proc_address_(name)); }

private:
    DynamicLibrary library_;
    decltype(&OSMesaDestroyContext) destroy_;
    decltype(&OSMesaMakeCurrent) make_current_;
    decltype(&OSMesaGetProcAddress) get_proc_address_;
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4 * default_framebuffer_size * default_framebuffer_size> buffer_{};
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace tumble

#else  // Mesa 25.1 or later

std::unique_ptr<tumble::GlContext> tumble::make_osmesa_context() {
    throw RunError("this program was built without OSMesa; Mesa 25.1 and later draw by EGL");
}

#endif
