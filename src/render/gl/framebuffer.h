// The picture's own framebuffers: color and depth with several samples a pixel, the background that is put back where
// something has moved, and the single-sample color that the samples are averaged into. The shaders write sRGB
// themselves: GL_FRAMEBUFFER_SRGB would encode each sample anew (+4 % of a frame), and edges are averaged as they are
// displayed, which keeps a bright edge before a dark ground from growing a staircase.
#pragma once

#include "core/image.h"
#include "core/rectangle.h"
#include "render/gl/gl_object.h"

#include <optional>
#include <vector>

namespace tumble {

class Framebuffer {
public:
    /// Throws RunError when the driver has no room for this size. Samples beyond the driver's most are cut to it.
    Framebuffer(const GlFunctions& gl, int width, int height, int samples);

    int samples() const { return samples_; }

    /// Makes the background the target of what is drawn next, over its whole area, and clears its depths.
    void begin_background();

    /// Makes the picture the target of what is drawn next, over its whole area, and clears its depths: for a background
    /// that is not worth keeping.
    void begin_whole();

    /// Makes the picture the target of what is drawn next. Only the rectangles can be drawn to: they get the background's
    /// colors and depths; everywhere else depth is nearest. `closing`: what could be drawn to before and cannot now, at
    /// least.
    void begin(const std::vector<Rectangle>& rectangles, const std::vector<Rectangle>& closing);

    /// Averages the samples there.
    void resolve(const std::vector<Rectangle>& rectangles) const;

    /// Copies the resolved picture there. The drawing has its first row at the bottom, so rows arrive in the image's order.
    void read(const std::vector<Rectangle>& rectangles, Image& image) const;

private:
    struct Target {
        GlObject framebuffer, color, depth;
    };
    Target make_target(int height, int samples, bool with_color, bool with_depth) const;
    void bind(const Target& target) const;
    void begin_all(const Target& target, double depth) const;
    void copy(const Target& from, const Target& to, const std::vector<Rectangle>& rectangles, GLbitfield what) const;
    void close(const std::vector<Rectangle>& rectangles) const;

    const GlFunctions* gl_;
    int width_, height_, samples_;
    Target background_, drawn_;
    Target closed_;   // a strip of nearest depths. Copied to where the picture was open: a third of what clearing costs
    bool whole_open_ = false;         // all of the picture can be drawn to
    std::optional<Target> resolved_;  // only with several samples
};

}  // namespace tumble
