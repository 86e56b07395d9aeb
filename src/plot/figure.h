// Line plots: panels one above the other over one horizontal axis.
#pragma once

#include "plot/axis.h"
#include "plot/canvas.h"

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
    bool dark = false;  // light lines on a dark ground
    static Theme light();
    /// For plots on a frame: light text on a dark, translucent ground.
    static Theme on_picture();
};

struct Figure {
    std::string title, subtitle;
    std::string x_title;  // quantity and unit, below the lowest panel
    std::vector<Panel> panels;
    Theme theme = Theme::light();
    double text_size = 13.0;  // in units of the canvas
};

/// A color that people with color blindness can tell from the others (after Okabe and Ito 2008, the yellow darkened).
Color series_color(std::size_t index, bool on_dark = false);

/// Where draw() has put the axes, on the canvas.
struct FigurePlaces {
    struct PlacedPanel {
        Axis y;
        Box2 box;
    };
    Axis x = Axis::linear(0.0, 1.0, 2);
    std::vector<PlacedPanel> panels;

    double x_of(double value) const;
};

FigurePlaces draw(const Figure& figure, Canvas& canvas, const Box2& box);

/// Radius of the dots of a cursor, in units of the figure's text size.
inline constexpr double cursor_dot = 0.42;

/// A vertical line at x through all panels, with a dot on each series. `corner`: where the canvas's corner lies on
/// the canvas of draw(). Precondition: the figure has panels.
void draw_cursor(const Figure& figure, const FigurePlaces& places, double x, Canvas& canvas, const Point2& corner);

}  // namespace tumble
