#include "render/gl/gl_context.h"

#include "core/dynamic_library.h"
#include "core/error.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <string_view>

namespace tumble {
namespace {

constexpr std::array egl_library_names = {"libEGL.so.1", "libEGL.so"};
constexpr const char* packages = "libegl1 libegl-mesa0 libgl1-mesa-dri";

class EglContext final : public GlContext {
public:
    explicit EglContext(EglDisplayKind kind)
        : library_(egl_library_names, "the rendering library", packages),
          get_proc_address_(library_.require<decltype(&eglGetProcAddress)>("eglGetProcAddress")),
          get_error_(library_.require<decltype(&eglGetError)>("eglGetError")),
          make_current_(library_.require<decltype(&eglMakeCurrent)>("eglMakeCurrent")),
          destroy_context_(library_.require<decltype(&eglDestroyContext)>("eglDestroyContext")),
          terminate_(library_.require<decltype(&eglTerminate)>("eglTerminate")) {
        const bool any = kind == EglDisplayKind::any;
        if (!(any && open_surfaceless()) && !open_device(kind))
            throw RunError(fmt::format("EGL offers {} (EGL error 0x{:x}); install Mesa's with 'apt-get install {}'",
                                       any ? "neither a surfaceless nor a device display" : "no software device",
                                       get_error_(), packages));
        create_context();
    }

    ~EglContext() override {
        make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context_ != EGL_NO_CONTEXT) destroy_context_(display_, context_);
        terminate_(display_);
    }

    void make_current() override {
        if (!make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            throw RunError(
                fmt::format("EGL cannot make a context current without a surface (error 0x{:x})", get_error_()));
    }

    void* get_proc_address(const char* name) const override { return reinterpret_cast<void*>(get_proc_address_(name)); }

private:
    bool initialize(EGLDisplay display) {
        const auto start = library_.require<decltype(&eglInitialize)>("eglInitialize");
        if (display == EGL_NO_DISPLAY || !start(display, nullptr, nullptr)) return false;
        display_ = display;
        return true;
    }

    PFNEGLGETPLATFORMDISPLAYEXTPROC platform_display() const {
        return reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(get_proc_address_("eglGetPlatformDisplayEXT"));
    }

    bool has_client_extension(std::string_view name) const {
        const auto query = library_.require<decltype(&eglQueryString)>("eglQueryString");
        const char* all = query(EGL_NO_DISPLAY, EGL_EXTENSIONS);
        return all != nullptr && std::string_view(all).find(name) != std::string_view::npos;
    }

    bool open_surfaceless() {
        if (!has_client_extension("EGL_MESA_platform_surfaceless") || platform_display() == nullptr) return false;
        return initialize(platform_display()(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    }

    bool is_software(EGLDeviceEXT device) const {
        const auto query =
            reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(get_proc_address_("eglQueryDeviceStringEXT"));
        const char* const all = query != nullptr ? query(device, EGL_EXTENSIONS) : nullptr;
        return all != nullptr && std::string_view(all).find("EGL_MESA_device_software") != std::string_view::npos;
    }

    bool open_device(EglDisplayKind kind) {
        const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(get_proc_address_("eglQueryDevicesEXT"));
        if (!has_client_extension("EGL_EXT_platform_device") || query == nullptr || platform_display() == nullptr)
            return false;
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (!query(EGLint(devices.size()), devices.data(), &count)) return false;
        for (EGLint i = 0; i < count; ++i) {
            const EGLDeviceEXT device = devices[std::size_t(i)];
            if (kind == EglDisplayKind::software && !is_software(device)) continue;
            if (initialize(platform_display()(EGL_PLATFORM_DEVICE_EXT, device, nullptr))) return true;
        }
        return false;
    }

    void create_context() {
        const auto bind_api = library_.require<decltype(&eglBindAPI)>("eglBindAPI");
        const auto choose = library_.require<decltype(&eglChooseConfig)>("eglChooseConfig");
        const auto create = library_.require<decltype(&eglCreateContext)>("eglCreateContext");
        const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        // A config is a formality, because all drawing goes to framebuffer objects; a device may offer none.
        if (!choose(display_, wanted, &config, 1, &count) || count == 0) config = EGL_NO_CONFIG_KHR;
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     gl_major,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     gl_minor,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        if (bind_api(EGL_OPENGL_API)) context_ = create(display_, config, EGL_NO_CONTEXT, attributes);
        if (context_ == EGL_NO_CONTEXT) {
            const EGLint error = get_error_();
            terminate_(display_);
            throw RunError(
                fmt::format("EGL cannot make an OpenGL {}.{} core context (error 0x{:x})", gl_major, gl_minor, error));
        }
    }

    DynamicLibrary library_;
    decltype(&eglGetProcAddress) get_proc_address_;
    decltype(&eglGetError) get_error_;
    decltype(&eglMakeCurrent) make_current_;
    decltype(&eglDestroyContext) destroy_context_;
    decltype(&eglTerminate) terminate_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlContext> make_egl_context(EglDisplayKind kind) { return std::make_unique<EglContext>(kind); }

}  // namespace tumble
