// A surface for lines and text, as an image in memory or as the bytes of an SVG, PDF or PNG file. Shapes are drawn by
// Cairo, text is set by Pango: the bytes are the same for the same versions of these and the same fonts.
#pragma once

#include "core/color.h"
#include "core/image.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

struct Point2 {
    double x = 0.0, y = 0.0;  // from the left and the top edge, in units of the canvas
};

struct Box2 {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
    double width() const { return right - left; }
    double height() const { return bottom - top; }
};

/// A color with opacity, 0 to 1.
struct Paint {
    Color color;
    double opacity = 1.0;
};

struct TextStyle {
    double size = 13.0;  // height of the letters' em square, in units of the canvas
    Paint paint;
    bool bold = false;
    double anchor = 0.0;  // the fraction of the text's width that lies left of its point
};

class Canvas {
public:
    enum class Format { png, svg, pdf };

    /// A file of that format, in memory. A unit is a pixel of a PNG, a point (1/72 inch) of a PDF.
    Canvas(Format format, double width, double height);
    /// A transparent image with `scale` pixels a unit.
    Canvas(int width_pixels, int height_pixels, double scale);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    void fill(const Box2& box, const Paint& paint, double corner_radius = 0.0);
    /// A line through the points; a point that is not finite interrupts it. `dash`: length of dashes and gaps; 0: none.
    void polyline(std::span<const Point2> points, const Paint& paint, double width, double dash = 0.0);
    void disc(const Point2& center, double radius, const Paint& paint);
    /// Draws inside the box only, until unclip().
    void clip(const Box2& box);
    void unclip();

    /// `at`: where the baseline meets the anchor.
    void text(const Point2& at, std::string_view text, const TextStyle& style);
    double text_width(std::string_view text, const TextStyle& style) const;
    /// The family of the font that text is set in; empty if there is none. "Inter" wherever it is installed.
    std::string font_family() const;

    /// The whole file. Call it once, last. Throws RunError if Cairo fails.
    std::string finish();
    /// Pixels of a transparent image: RGBA with straight (not premultiplied) alpha.
    Image image() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tumble
