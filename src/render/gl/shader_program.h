// A linked shader program.
#pragma once

#include "render/gl/gl_object.h"

#include <glm/vec4.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

struct ShaderFiles {
    std::string vertex, fragment;      // names in the shader folder; no fragment shader: depth only
    std::vector<std::string> defines;  // given to both
};

class ShaderProgram {
public:
    /// Throws RunError with the compiler's log, with file names in it.
    ShaderProgram(const GlFunctions& gl, const std::filesystem::path& folder, const ShaderFiles& files);

    void use() const { gl_->UseProgram(program_.name()); }

    /// Location of a uniform (-1, which OpenGL ignores, if the compiler removed it).
    GLint uniform(const char* name) const { return gl_->GetUniformLocation(program_.name(), name); }

    /// Sets a uniform of the program in use.
    void set(const char* name, const glm::vec4& value) const;

    /// Binds a sampler to a texture unit, a uniform block to a binding point; the names may be absent.
    void set_sampler(const char* name, GLint unit) const;
    void set_block(const char* name, GLuint binding) const;

private:
    const GlFunctions* gl_;
    GlObject program_;
};

}  // namespace tumble
