#include "app/composition/plot_layer.h"

#include <cmath>

namespace tumble {

PlotLayer::PlotLayer(const ClipPlot& plot) : plot_(plot) {
    const double width = plot.place.width, height = plot.place.height;
    Canvas canvas(plot.place.width, plot.place.height, 1.0);
    places_ = draw(plot.figure, canvas, {0.0, 0.0, width, height});
    curves_ = {plot.place, canvas.image()};
}

void PlotLayer::update(double time, std::vector<Rectangle>& changed) {
    if (time_ == time) return;
    if (time_) changed.push_back(cursor_.box);
    time_ = time;
    const double reach = cursor_dot * plot_.figure.text_size + 1.0;
    const double left = std::floor(places_.x_of(time) - reach);
    const Rectangle strip{plot_.place.x + int(left), plot_.place.y, int(std::ceil(2.0 * reach)) + 1,
                          plot_.place.height};
    cursor_.box = intersection(strip, plot_.place);
    if (cursor_.box.width == 0) return;
    Canvas canvas(cursor_.box.width, cursor_.box.height, 1.0);
    draw_cursor(plot_.figure, places_, time, canvas, {double(cursor_.box.x - plot_.place.x), 0.0});
    cursor_.pixels = canvas.image();
    changed.push_back(cursor_.box);
}

void PlotLayer::add_stamps(std::vector<const Stamp*>& stamps) const {
    stamps.push_back(&curves_);
    stamps.push_back(&cursor_);
}

}  // namespace tumble
