#include "render/gl/shader_program.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "render/gl/shader_source.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace tumble {
namespace {

std::string shader_log(const GlFunctions& gl, GLuint shader) {
    GLint length = 0;
    gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(std::max(length, 1)), '\0');
    gl.GetShaderInfoLog(shader, length, nullptr, log.data());
    return log.c_str();
}

void attach(const GlFunctions& gl, GLuint program, GLenum stage, const std::filesystem::path& folder,
            const std::string& name, const std::vector<std::string>& defines) {
    const ShaderSource source = read_shader(folder, name, defines);
    const GLuint shader = gl.CreateShader(stage);
    const char* text = source.text.c_str();
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    GLint compiled = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    const std::string log = compiled != 0 ? std::string() : shader_log(gl, shader);
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);  // the program keeps it
    if (compiled == 0)
        throw RunError(
            fmt::format("shader {} does not compile:\n{}", safe_path(folder / name), source.with_file_names(log)));
}

}  // namespace

ShaderProgram::ShaderProgram(const GlFunctions& gl, const std::filesystem::path& folder, const ShaderFiles& files)
    : gl_(&gl), program_(gl, GlKind::program) {
    const GLuint program = program_.name();
    attach(gl, program, GL_VERTEX_SHADER, folder, files.vertex, files.defines);
    if (!files.fragment.empty()) attach(gl, program, GL_FRAGMENT_SHADER, folder, files.fragment, files.defines);
    gl.LinkProgram(program);
    GLint linked = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == 0) {
        std::string log(4096, '\0');
        gl.GetProgramInfoLog(program, GLsizei(log.size()), nullptr, log.data());
        throw RunError(fmt::format("shaders {} and {} do not link:\n{}", safe_path(folder / files.vertex),
                                   safe_path(folder / files.fragment), log.c_str()));
    }
}

void ShaderProgram::set(const char* name, const glm::vec4& value) const {
    gl_->Uniform4fv(uniform(name), 1, glm::value_ptr(value));
}

void ShaderProgram::set_sampler(const char* name, GLint unit) const {
    use();
    gl_->Uniform1i(uniform(name), unit);
}

void ShaderProgram::set_block(const char* name, GLuint binding) const {
    const GLuint index = gl_->GetUniformBlockIndex(program_.name(), name);
    if (index != GL_INVALID_INDEX) gl_->UniformBlockBinding(program_.name(), index, binding);
}

}  // namespace tumble
