// A part of a frame that is drawn over its panels: text, or a plot.
#pragma once

#include "core/image.h"
#include "plot/canvas.h"
#include "scene/description/mesh_paint.h"

#include <string>
#include <string_view>

namespace tumble {

struct Stamp {
    Rectangle box;
    Image pixels;  // of the size of the box, with straight alpha

    /// Draws onto the part of the frame inside the region.
    void blend(Image& frame, const Rectangle& region) const;
};

/// The common pixels of two rectangles; empty (width 0) if there are none.
Rectangle intersection(const Rectangle& a, const Rectangle& b);

/// Text of one style in a box.
struct TextBox {
    Rectangle area;  // the text and its ground stay inside
    double across = 0.0,
           down = 0.0;   // place in the area: 0 at the left and the top edge, 1 at the right and the bottom
    double size = 20.0;  // height of the em square, pixels; smaller if the text does not fit
    Color color{250, 251, 253};
    bool bold = false;
    bool ground = true;  // a dark translucent rounded rectangle behind the text
    std::string widest;  // the box has space for this text; empty: for the text itself
};

/// Sets text in lines of the box's width. Text that does not fit is set smaller.
Stamp set_text(std::string_view text, const TextBox& box);

// -- An image at another size: the mean of the light that its pixels cover, weighted by their alpha.

/// sRGB with straight alpha, which is multiplied by the opacity. A larger image is interpolated.
Image scaled_image(const Texture::Level& image, int width, int height, double opacity);

}  // namespace tumble
