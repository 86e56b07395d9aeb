#include "app/composition/frame_layout.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr std::size_t most_in_automatic_row = 3;
constexpr int least_panel_side = 48, least_plot_width = 160, least_plot_height = 100;  // pixels
// Fractions of the text unit.
constexpr double gap_size = 0.014, header_height = 0.09, label_height = 0.06, caption_height = 0.075,
                 footer_height = 0.05, inset_margin = 0.03, below_clock = 0.11;
// Fractions of the frame or the area.
constexpr double beside_share = 1.0 / 3.0, below_share = 0.37, inset_width = 0.4, inset_height = 0.34,
                 inset_growth = 0.17, most_inset = 0.8;

int even(double length) { return 2 * std::max(1, int(std::lround(0.5 * length))); }
int even_part(int length, int parts) { return length / parts / 2 * 2; }

void require_panel(const LayoutRequest& request, const Rectangle& panel) {
    const bool whole = panel == Rectangle{0, 0, request.width, request.height};  // any size is good without a division
    if (whole || std::min(panel.width, panel.height) >= least_panel_side) return;
    throw InputError(fmt::format(
        "--size: a picture of {} x {} pixels is too small for {} panel{}{} (each would have {} x {} pixels; "
        "{} are needed on each side)",
        request.width, request.height, request.panels, request.panels == 1 ? "" : "s",
        request.plot && *request.plot != PlotPlace::inset ? " and a plot" : "", std::max(panel.width, 0),
        std::max(panel.height, 0), least_panel_side));
}

Rectangle inset_in(const Rectangle& area, const LayoutRequest& request, double unit) {
    const int margin = even(inset_margin * unit), top = request.clock ? even(below_clock * unit) : margin;
    const double share = std::min(inset_height + inset_growth * double(request.plot_panels - 1), most_inset);
    Rectangle plot;
    plot.width = even(inset_width * area.width);
    plot.height = std::min(even(share * area.height), area.height - top - margin);
    plot.x = area.x + area.width - plot.width - margin;
    plot.y = area.y + top;
    return plot;
}

/// Cuts the plot's place off the space of the panels.
Rectangle cut_plot(Rectangle& space, PlotPlace place, int gap) {
    Rectangle plot = space;
    if (place == PlotPlace::beside) {
        plot.width = even(beside_share * space.width);
        plot.x = space.x + space.width - plot.width;
        space.width -= plot.width + gap;
    } else {
        plot.height = even(below_share * space.height);
        plot.y = space.y + space.height - plot.height;
        space.height -= plot.height + gap;
    }
    return plot;
}

void divide(const LayoutRequest& request, const Rectangle& space, int gap, double unit, FrameLayout& layout) {
    const auto count = int(request.panels);
    const bool row = request.arrangement == PanelArrangement::row ||
                     (request.arrangement == PanelArrangement::automatic && request.panels <= most_in_automatic_row);
    const int columns = row ? count : int(std::ceil(std::sqrt(double(count))));
    const int rows = (count + columns - 1) / columns;
    const int label = even(label_height * unit);
    const int width = even_part(space.width - (columns - 1) * gap, columns);
    const int height = even_part(space.height - (rows - 1) * gap, rows);
    for (int i = 0; i < count; ++i) {
        const int x = space.x + i % columns * (width + gap), y = space.y + i / columns * (height + gap);
        layout.labels.push_back({x, y, width, label});
        layout.panels.push_back({x, y + label, width, height - label});
    }
    const Rectangle &first = layout.panels.front(), &last = layout.panels.back();
    layout.area = {space.x, first.y, columns * (width + gap) - gap, last.y + last.height - first.y};
}

}  // namespace

double text_unit(int width, int height) { return std::min(double(height), 0.8 * width); }

FrameLayout lay_out(const LayoutRequest& given) {
    LayoutRequest request = given;
    if (request.panels > 1 && request.plot == PlotPlace::inset) request.plot = PlotPlace::below;
    const double unit = text_unit(request.width, request.height);
    const bool several = request.panels > 1;
    const int gap = several ? even(gap_size * unit) : 0;
    FrameLayout layout;
    Rectangle space{gap, 0, request.width - 2 * gap, request.height - gap};
    if (several && request.header) {
        layout.header = {gap, 0, space.width, even(header_height * unit)};
        space.y += layout.header.height;
        space.height -= layout.header.height;
    }
    const auto cut_band = [&](double share) {
        const int height = even(share * unit);
        space.height -= height;
        return Rectangle{gap, space.y + space.height, space.width, height};
    };
    if (several && request.footer) layout.footer = cut_band(footer_height);
    if (several && request.captions) layout.captions = cut_band(caption_height);
    Rectangle plot;
    if (request.plot && *request.plot != PlotPlace::inset) plot = cut_plot(space, *request.plot, gap);
    if (several) {
        divide(request, space, gap, unit, layout);
    } else {
        layout.panels.push_back(space);
        layout.area = space;
    }
    require_panel(request, layout.panels.front());
    if (!request.plot) return layout;
    layout.plots_on_picture = *request.plot == PlotPlace::inset;
    if (layout.plots_on_picture) plot = inset_in(layout.area, request, unit);
    if (*request.plot == PlotPlace::below) {
        const auto columns = int(request.plot_panels);
        plot.width /= columns;
        for (int i = 0; i < columns; ++i)
            layout.plots.push_back({plot.x + i * plot.width, plot.y, plot.width, plot.height});
    } else {
        layout.plots.push_back(plot);
    }
    if (plot.width < least_plot_width || plot.height < least_plot_height)
        throw InputError(fmt::format(
            "--plot: a picture of {} x {} pixels is too small for a plot (it would have {} x {} "
            "pixels; {} x {} are needed)",
            request.width, request.height, plot.width, std::max(plot.height, 0), least_plot_width, least_plot_height));
    return layout;
}

}  // namespace tumble
