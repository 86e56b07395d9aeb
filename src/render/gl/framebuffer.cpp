#include "render/gl/framebuffer.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

constexpr int nearest_strip_rows =
    64;  // of nearest depths, so that the source of copies stays in the processor's cache

int integer(const GlFunctions& gl, GLenum name) {
    GLint value = 0;
    gl.GetIntegerv(name, &value);
    return value;
}

int supported_samples(const GlFunctions& gl, int wanted) {
    const int most = std::max(1, integer(gl, GL_MAX_SAMPLES));
    return wanted <= 1 ? 1 : std::min(wanted, most);
}

}  // namespace

Framebuffer::Framebuffer(const GlFunctions& gl, int width, int height, int samples)
    : gl_(&gl),
      width_(width),
      height_(height),
      samples_(supported_samples(gl, samples)),
      background_(make_target(height, samples_, true, true)),
      drawn_(make_target(height, samples_, true, true)),
      closed_(make_target(std::min(nearest_strip_rows, height), samples_, false, true)) {
    if (samples_ > 1) resolved_.emplace(make_target(height, 1, true, false));
    begin_all(closed_, 0.0);
    begin_all(drawn_, 0.0);
}

Framebuffer::Target Framebuffer::make_target(int height, int samples, bool with_color, bool with_depth) const {
    const int most = integer(*gl_, GL_MAX_RENDERBUFFER_SIZE);
    if (width_ > most || height_ > most)
        throw RunError(fmt::format("the OpenGL driver draws pictures of at most {0} x {0} pixels, not {1} x {2}", most,
                                   width_, height_));
    Target target{GlObject(*gl_, GlKind::framebuffer), GlObject(*gl_, GlKind::renderbuffer),
                  GlObject(*gl_, GlKind::renderbuffer)};
    const GLsizei stored = samples > 1 ? samples : 0;
    gl_->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
    if (with_color) {
        gl_->BindRenderbuffer(GL_RENDERBUFFER, target.color.name());
        gl_->RenderbufferStorageMultisample(GL_RENDERBUFFER, stored, GL_RGBA8, width_, height);
        gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.color.name());
    } else {
        gl_->DrawBuffer(GL_NONE);
        gl_->ReadBuffer(GL_NONE);
    }
    if (with_depth) {
        gl_->BindRenderbuffer(GL_RENDERBUFFER, target.depth.name());
        gl_->RenderbufferStorageMultisample(GL_RENDERBUFFER, stored, GL_DEPTH_COMPONENT32F, width_, height);
        gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth.name());
    }
    const GLenum status = gl_->CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE || gl_->GetError() == GL_OUT_OF_MEMORY)
        throw RunError(fmt::format("the OpenGL driver refuses a framebuffer of {} x {} pixels with {} samples (0x{:x})",
                                   width_, height_, samples, status));
    return target;
}

void Framebuffer::bind(const Target& target) const {
    gl_->BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
    gl_->Viewport(0, 0, width_, height_);
    gl_->Disable(GL_FRAMEBUFFER_SRGB);
}

void Framebuffer::copy(const Target& from, const Target& to, const std::vector<Rectangle>& rectangles,
                       GLbitfield what) const {
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer.name());
    gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, to.framebuffer.name());
    for (const Rectangle& r : rectangles)
        gl_->BlitFramebuffer(r.x, r.y, r.x + r.width, r.y + r.height, r.x, r.y, r.x + r.width, r.y + r.height, what,
                             GL_NEAREST);
}

void Framebuffer::close(const std::vector<Rectangle>& rectangles) const {
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, closed_.framebuffer.name());
    gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, drawn_.framebuffer.name());
    for (const Rectangle& r : rectangles)
        for (int y = r.y; y < r.y + r.height; y += nearest_strip_rows) {
            const int rows = std::min(nearest_strip_rows, r.y + r.height - y);
            gl_->BlitFramebuffer(r.x, 0, r.x + r.width, rows, r.x, y, r.x + r.width, y + rows, GL_DEPTH_BUFFER_BIT,
                                 GL_NEAREST);
        }
}

void Framebuffer::begin_all(const Target& target, double depth) const {
    bind(target);
    gl_->ClearDepth(depth);
    gl_->Clear(GL_DEPTH_BUFFER_BIT);  // the sky covers all colors at the latest
}

void Framebuffer::clear_color(const std::array<float, 4>& color) const {
    gl_->ClearColor(color[0], color[1], color[2], color[3]);
    gl_->Clear(GL_COLOR_BUFFER_BIT);
}

void Framebuffer::begin_background() { begin_all(background_, 1.0); }

void Framebuffer::begin_whole() {
    begin_all(drawn_, 1.0);
    whole_open_ = true;
    drawn_over_ = false;
}

void Framebuffer::begin(const std::vector<Rectangle>& rectangles, const std::vector<Rectangle>& previous_damage) {
    close(whole_open_ ? std::vector<Rectangle>{{0, 0, width_, height_}} : previous_damage);
    copy(background_, drawn_, rectangles, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    bind(drawn_);
    whole_open_ = false;
}

Framebuffer::Over Framebuffer::make_over() const {
    Over over{GlObject(*gl_, GlKind::framebuffer), GlObject(*gl_, GlKind::texture), GlObject(*gl_, GlKind::texture),
              GlObject(*gl_, GlKind::framebuffer), GlObject(*gl_, GlKind::renderbuffer)};
    const auto make_texture = [&](const GlObject& texture, GLint stored, GLenum format, GLenum type) {
        gl_->BindTexture(GL_TEXTURE_2D, texture.name());
        gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        gl_->TexImage2D(GL_TEXTURE_2D, 0, stored, width_, height_, 0, format, type, nullptr);
    };
    make_texture(over.seen_color, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    make_texture(over.seen_depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT);
    gl_->BindFramebuffer(GL_FRAMEBUFFER, over.seen.name());
    gl_->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, over.seen_color.name(), 0);
    gl_->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, over.seen_depth.name(), 0);
    gl_->BindFramebuffer(GL_FRAMEBUFFER, over.target.name());
    const Target& picture = resolved_ ? *resolved_ : drawn_;
    gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, picture.color.name());
    gl_->BindRenderbuffer(GL_RENDERBUFFER, over.depth.name());
    gl_->RenderbufferStorageMultisample(GL_RENDERBUFFER, 0, GL_DEPTH_COMPONENT32F, width_, height_);
    gl_->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, over.depth.name());
    const GLenum status = gl_->CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw RunError(fmt::format("the OpenGL driver refuses a framebuffer for water (0x{:x})", status));
    return over;
}

void Framebuffer::begin_over() {
    const std::vector<Rectangle> whole{{0, 0, width_, height_}};
    resolve(whole);
    if (!over_) over_.emplace(make_over());
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.framebuffer.name());
    gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, over_->seen.name());
    for (const GLbitfield what : {GL_COLOR_BUFFER_BIT, GL_DEPTH_BUFFER_BIT})
        gl_->BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, what, GL_NEAREST);
    gl_->BindFramebuffer(GL_FRAMEBUFFER, over_->target.name());
    gl_->Viewport(0, 0, width_, height_);
    gl_->ClearDepth(1.0);
    gl_->Clear(GL_DEPTH_BUFFER_BIT);
    drawn_over_ = true;
}

void Framebuffer::resolve(const std::vector<Rectangle>& rectangles) const {
    if (resolved_ && !drawn_over_) copy(drawn_, *resolved_, rectangles, GL_COLOR_BUFFER_BIT);
}

void Framebuffer::read(const std::vector<Rectangle>& rectangles, Image& image) const {
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, resolved_ ? resolved_->framebuffer.name() : drawn_.framebuffer.name());
    gl_->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl_->PixelStorei(GL_PACK_ROW_LENGTH, width_);
    for (const Rectangle& r : rectangles)
        gl_->ReadPixels(r.x, r.y, r.width, r.height, GL_RGBA, GL_UNSIGNED_BYTE, image.at(r.x, r.y));
}

void Framebuffer::read_depths(const std::vector<Rectangle>& rectangles, DepthImage& depths) {
    const Target* source = &drawn_;
    if (samples_ > 1) {
        if (!resolved_depth_) resolved_depth_.emplace(make_target(height_, 1, false, true));
        copy(drawn_, *resolved_depth_, rectangles, GL_DEPTH_BUFFER_BIT);
        source = &*resolved_depth_;
    }
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, source->framebuffer.name());
    gl_->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl_->PixelStorei(GL_PACK_ROW_LENGTH, width_);
    for (const Rectangle& r : rectangles)
        gl_->ReadPixels(r.x, r.y, r.width, r.height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.at(r.x, r.y));
}

}  // namespace tumble
