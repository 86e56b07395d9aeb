#include "render/gl/gl_device.h"

#include "core/error.h"

namespace tumble {

GlDevice::GlDevice(GlBackend backend)
    : context_(make_gl_context(backend)),
      gl_(load_gl_functions([this](const char* name) { return context_->get_proc_address(name); })) {}

GlDevice::~GlDevice() {
    try {
        make_current();
    } catch (const RunError&) {
    }
}

const ShaderProgram& GlDevice::program(const std::filesystem::path& folder, const ShaderFiles& files) {
    auto& made = programs_[{folder.string(), files.vertex, files.fragment, files.defines}];
    if (!made) made = std::make_unique<ShaderProgram>(gl_, folder, files);
    return *made;
}

}  // namespace tumble
