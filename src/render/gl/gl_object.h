// An OpenGL object that is deleted with its owner. The context that made it must be current at that time.
#pragma once

#include "render/gl/gl_functions.h"

#include <utility>

namespace tumble {

enum class GlKind { buffer, vertex_array, texture, framebuffer, renderbuffer, program };

class GlObject {
public:
    GlObject(const GlFunctions& gl, GlKind kind) : gl_(&gl), kind_(kind) {
        switch (kind) {
            case GlKind::buffer:
                gl.GenBuffers(1, &name_);
                break;
            case GlKind::vertex_array:
                gl.GenVertexArrays(1, &name_);
                break;
            case GlKind::texture:
                gl.GenTextures(1, &name_);
                break;
            case GlKind::framebuffer:
                gl.GenFramebuffers(1, &name_);
                break;
            case GlKind::renderbuffer:
                gl.GenRenderbuffers(1, &name_);
                break;
            case GlKind::program:
                name_ = gl.CreateProgram();
                break;
        }
    }
    GlObject(GlObject&& other) noexcept : gl_(other.gl_), kind_(other.kind_), name_(std::exchange(other.name_, 0)) {}
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;
    GlObject& operator=(GlObject&&) = delete;
    ~GlObject() {
        if (name_ == 0) return;
        switch (kind_) {
            case GlKind::buffer:
                gl_->DeleteBuffers(1, &name_);
                break;
            case GlKind::vertex_array:
                gl_->DeleteVertexArrays(1, &name_);
                break;
            case GlKind::texture:
                gl_->DeleteTextures(1, &name_);
                break;
            case GlKind::framebuffer:
                gl_->DeleteFramebuffers(1, &name_);
                break;
            case GlKind::renderbuffer:
                gl_->DeleteRenderbuffers(1, &name_);
                break;
            case GlKind::program:
                gl_->DeleteProgram(name_);
                break;
        }
    }

    GLuint name() const { return name_; }

private:
    const GlFunctions* gl_;
    GlKind kind_;
    GLuint name_ = 0;
};

}  // namespace tumble
