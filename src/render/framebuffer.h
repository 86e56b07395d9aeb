// The picture's own framebuffer: colour and depth with several samples a pixel, and the single-sample colour that they
// are averaged into. The shaders write sRGB themselves: GL_FRAMEBUFFER_SRGB would encode each sample anew (+4 % of a
// frame), and edges are averaged as they are displayed, which keeps a bright edge before a dark ground from growing a
// staircase.
#pragma once

#include "core/image.h"
#include "render/gl_object.h"

#include <optional>

namespace tumble {

class Framebuffer {
public:
    /// Throws RunError when the driver has no room for this size. Samples beyond the driver's most are cut to it.
    Framebuffer(const GlFunctions& gl, int width, int height, int samples);

    int samples() const { return samples_; }

    /// Makes this the target of what is drawn next, over its whole area.
    void bind() const;

    /// Averages the samples.
    void resolve() const;

    /// Copies the resolved picture. The drawing has its first row at the bottom, so rows arrive in the image's order.
    void read(Image& image) const;

private:
    struct Target {
        GlObject framebuffer, color, depth;
    };
    Target make_target(int samples, bool with_depth) const;

    const GlFunctions* gl_;
    int width_, height_, samples_;
    Target drawn_;
    std::optional<Target> resolved_;  // only with several samples
};

}  // namespace tumble
