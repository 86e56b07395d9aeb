#include "app/lesson/convergence_figure.h"

#include "core/html_text.h"
#include "page/run_html.h"
#include "plot/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble {
namespace {

// In units of the picture.
constexpr double figure_width = 680.0, figure_height = 400.0;
constexpr double left = 64.0, right = 500.0, top = 16.0, bottom = 348.0;
constexpr double label_gap = 17.0;  // between the names of two lines
/// Lower end of the axis. Smaller errors are rounding and would take most of the picture: they are drawn at this end.
constexpr double least_error = 1e-17;

struct Picture {
    Axis x, y;

    double across(double step) const { return left + (right - left) * x.place(step); }
    double down(double error) const { return bottom - (bottom - top) * y.place(std::max(error, y.least())); }
};

Picture axes_of(std::span<const ConvergenceLine> lines) {
    double least_x = INFINITY, most_x = 0.0, least_y = INFINITY, most_y = least_error;
    for (const ConvergenceLine& line : lines)
        for (std::size_t i = 0; i < line.steps.size(); ++i) {
            least_x = std::min(least_x, line.steps[i]);
            most_x = std::max(most_x, line.steps[i]);
            least_y = std::min(least_y, std::max(line.errors[i], least_error));
            most_y = std::max(most_y, line.errors[i]);
        }
    return {Axis::logarithmic(least_x, most_x, 4), Axis::logarithmic(least_y, most_y, 7)};
}

std::string grid(const Picture& picture) {
    std::string svg;
    for (const Axis::Tick& tick : picture.x.ticks()) {
        const double at = picture.across(tick.value);
        svg +=
            fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>", at, top, bottom);
        svg +=
            fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", at, bottom + 20, tick.label);
    }
    for (const Axis::Tick& tick : picture.y.ticks()) {
        const double at = picture.down(tick.value);
        svg +=
            fmt::format("<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>", left, right, at);
        svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 8, at + 4, tick.label);
    }
    svg += fmt::format(
        "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">step <tspan font-style=\"italic\">h</tspan> (s)</text>\n",
        0.5 * (left + right), bottom + 42);
    svg += fmt::format("<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">error</text>\n",
                       0.5 * (top + bottom));
    return svg;
}

/// Heights of the names beside the ends of the lines, moved apart where they would overlap.
std::vector<double> label_places(const Picture& picture, std::span<const ConvergenceLine> lines) {
    std::vector<std::size_t> order(lines.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto end_of = [&](std::size_t i) { return picture.down(lines[i].errors.back()); };
    std::ranges::stable_sort(order, {}, end_of);
    std::vector<double> places(lines.size());
    double next = top;
    for (const std::size_t i : order) {
        places[i] = std::max(end_of(i), next);
        next = places[i] + label_gap;
    }
    // The lowest ones may have left the picture.
    double most = bottom;
    for (auto i = order.rbegin(); i != order.rend(); ++i) {
        places[*i] = std::min(places[*i], most);
        most = places[*i] - label_gap;
    }
    return places;
}

std::string line_svg(const Picture& picture, const ConvergenceLine& line, std::size_t color, double label) {
    std::string path, dots;
    for (std::size_t i = 0; i < line.steps.size(); ++i) {
        const double x = picture.across(line.steps[i]), y = picture.down(line.errors[i]);
        path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x, y);
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>", x, y);
    }
    return fmt::format("<g class=\"series series-{}\"><path d=\"{}\"/>{}<text x=\"{}\" y=\"{:.1f}\">{}</text></g>\n",
                       color % 6 + 1, path, dots, right + 12, label + 4, html_text(line.integrator));
}

std::string slope_rows(const LessonConvergence& block, std::span<const ConvergenceLine> lines) {
    std::string rows;
    for (const ConvergenceLine& line : lines) {
        const auto stated = block.slopes.find(line.integrator);
        rows += fmt::format(
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
            "class=\"number\">{}</td></tr>\n",
            html_text(line.integrator), stated == block.slopes.end() ? "" : fmt::format("{:g}", stated->second),
            line.slope ? fmt::format("{:.2f}", *line.slope) : "none", number_html(line.errors.front(), 2));
    }
    return rows;
}

}  // namespace

std::string convergence_figure(const LessonConvergence& block, std::span<const ConvergenceLine> lines) {
    const Picture picture = axes_of(lines);
    const std::vector<double> labels = label_places(picture, lines);
    std::string svg = grid(picture);
    for (std::size_t i = 0; i < lines.size(); ++i) svg += line_svg(picture, lines[i], i, labels[i]);
    std::string html = fmt::format(
        "<figure class=\"convergence\">\n<svg viewBox=\"0 0 {:g} {:g}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n",
        figure_width, figure_height, html_text(block.alt), svg);
    html += fmt::format(
        "<div class=\"table\" role=\"group\" aria-label=\"Slopes\" tabindex=\"0\"><table>\n<thead><tr><th "
        "scope=\"col\">Integrator</th><th scope=\"col\">Order</th><th scope=\"col\">Fitted slope</th><th "
        "scope=\"col\">Error at the smallest step</th></tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
        slope_rows(block, lines));
    if (!block.caption_html.empty()) html += fmt::format("<figcaption>{}</figcaption>\n", block.caption_html);
    return html + "</figure>\n";
}

}  // namespace tumble
