// The framebuffers of a frame: color and depth with several samples per pixel, the stored background that is restored
// in dirty regions, and the single-sample color that the samples are averaged into. Shaders encode sRGB themselves:
// GL_FRAMEBUFFER_SRGB would encode each sample again (4 % of a frame). Edges are averaged as encoded values, which
// avoids a staircase on a bright edge before a dark background.
#pragma once

#include "core/image.h"
#include "render/gl/gl_object.h"

#include <array>
#include <optional>
#include <vector>

namespace tumble {

class Framebuffer {
public:
    /// Throws RunError if the driver has no room for this size. The number of samples is limited to the driver's
    /// maximum.
    Framebuffer(const GlFunctions& gl, int width, int height, int samples);

    int samples() const { return samples_; }

    /// Makes the background the draw target, over its whole area, and clears its depths.
    void begin_background();

    /// Fills the draw target with a color and alpha.
    void clear_color(const std::array<float, 4>& color) const;

    /// Makes the frame the draw target, over its whole area, and clears its depths; for a background that is not worth
    /// storing.
    void begin_whole();

    /// Makes the frame the draw target. Only the rectangles can be drawn to: they get the background's colors and
    /// depths; all other pixels have the nearest depth. `closing`: at least the pixels that could be drawn to in the
    /// previous frame and cannot in this one.
    void begin(const std::vector<Rectangle>& rectangles, const std::vector<Rectangle>& previous_damage);

    /// Copies the color, of which it averages the samples, and the depth to textures, and makes the color, with one
    /// sample and depths of its own, the draw target. Precondition: begin_whole(). After it, resolve() does nothing.
    void begin_over();
    GLuint seen_color() const { return over_->seen_color.name(); }
    GLuint seen_depth() const { return over_->seen_depth.name(); }

    /// Averages the samples in the rectangles.
    void resolve(const std::vector<Rectangle>& rectangles) const;

    /// Copies the resolved rectangles to the image. The drawing has its first row at the bottom, so rows arrive in the
    /// order of the image.
    void read(const std::vector<Rectangle>& rectangles, Image& image) const;

    /// Copies the depths of the buffer, 0 to 1; of several samples, one of them.
    void read_depths(const std::vector<Rectangle>& rectangles, DepthImage& depths);

private:
    struct Target {
        GlObject framebuffer, color, depth;
    };
    struct Over {
        GlObject seen, seen_color, seen_depth;  // copies of the frame
        GlObject target, depth;                 // to draw on, with the color of the frame
    };
    Target make_target(int height, int samples, bool with_color, bool with_depth) const;
    void bind(const Target& target) const;
    void begin_all(const Target& target, double depth) const;
    void copy(const Target& from, const Target& to, const std::vector<Rectangle>& rectangles, GLbitfield what) const;
    Over make_over() const;
    void close(const std::vector<Rectangle>& rectangles) const;

    const GlFunctions* gl_;
    int width_, height_, samples_;
    Target background_, drawn_;
    Target closed_;  // a strip of nearest depths, copied over pixels that are closed: a third of the cost of clearing
    bool drawn_over_ = false;               // after begin_over()
    bool whole_open_ = false;               // true if the whole frame can be drawn to
    std::optional<Target> resolved_;        // only with several samples
    std::optional<Target> resolved_depth_;  // the same; made on first use
    std::optional<Over> over_;              // made on first use
};

}  // namespace tumble
