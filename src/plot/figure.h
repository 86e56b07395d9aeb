// Line plots: panels one above the other over one horizontal axis.
#pragma once

#include "plot/canvas.h"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct Series {
    std::string label;
    std::vector<double> x, y;  // of equal length; values that are not finite leave a gap
    std::size_t color = 0;     // index into the palette
    bool dashed = false;
};

struct Panel {
    std::string title;  // quantity and unit, above the panel
    bool logarithmic = false;
    std::vector<Series> series;
};

struct Theme {
    Paint background, text, faint, grid;
    static Theme light();
    /// For plots on a frame: light text on a dark, translucent ground.
    static Theme on_picture();
};

struct Figure {
    std::string title, subtitle;
    std::string x_title;  // quantity and unit, below the lowest panel
    std::vector<Panel> panels;
    Theme theme = Theme::light();
    std::optional<double> cursor;  // x of a vertical line, with a dot on each series
    double text_size = 13.0;       // in units of the canvas
};

/// A color that people with color blindness can tell from the others (after Okabe and Ito 2008, the yellow darkened).
Color series_color(std::size_t index);

void draw(const Figure& figure, Canvas& canvas, const Box2& box);

}  // namespace tumble
