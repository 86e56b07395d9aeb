// An OpenGL context, its functions, and the shader programs that were compiled in it. It belongs to no scene: renderers
// of one scene after the other can use it (RenderSwitches::device), and each shader is compiled once.
#pragma once

#include "render/gl/gl_context.h"
#include "render/gl/shader_program.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace tumble {

class GlDevice {
public:
    /// Opens the context, current in this thread. Throws RunError.
    explicit GlDevice(GlBackend backend);
    /// Makes the context current, because the programs are deleted in it.
    ~GlDevice();
    GlDevice(const GlDevice&) = delete;
    GlDevice& operator=(const GlDevice&) = delete;

    void make_current() { context_->make_current(); }
    const GlFunctions& gl() const { return gl_; }

    /// The program of these files: compiled at the first request, and valid as long as the device. Uniforms keep the
    /// values of the last use: set all before a draw. Throws RunError (ShaderProgram).
    const ShaderProgram& program(const std::filesystem::path& folder, const ShaderFiles& files);

private:
    using Key = std::tuple<std::string, std::string, std::string, std::vector<std::string>>;

    std::unique_ptr<GlContext> context_;
    GlFunctions gl_;
    std::map<Key, std::unique_ptr<ShaderProgram>> programs_;
};

}  // namespace tumble
