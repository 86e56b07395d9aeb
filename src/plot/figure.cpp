#include "plot/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace tumble {
namespace {

struct Extent {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    void add(double value) {
        if (!std::isfinite(value)) return;
        least = std::min(least, value);
        most = std::max(most, value);
    }
    bool empty() const { return !(most >= least); }
};

Axis make_axis(const Extent& extent, bool logarithmic, int about) {
    if (extent.empty()) return Axis::linear(0.0, 1.0, about);
    if (logarithmic && extent.most > 0.0) return Axis::logarithmic(extent.least, extent.most, about);
    return Axis::linear(extent.least, extent.most, about);
}

/// The value of a series at x, between its points; nothing outside of them.
std::optional<double> value_at(const Series& series, double x) {
    const auto after = std::lower_bound(series.x.begin(), series.x.end(), x);
    if (after == series.x.end()) return std::nullopt;
    const auto k = std::size_t(after - series.x.begin());
    if (*after == x) return series.y[k];
    if (k == 0) return std::nullopt;
    const double share = (x - series.x[k - 1]) / (series.x[k] - series.x[k - 1]);
    return series.y[k - 1] + share * (series.y[k] - series.y[k - 1]);
}

/// Moves labels apart so that no two overlap, as little as possible, and keeps them in [top, bottom].
void spread(std::vector<double>& places, double height, double top, double bottom) {
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) { return places[l] < places[r]; });
    for (int round = 0; round < 50; ++round) {
        for (std::size_t k = 0; k + 1 < order.size(); ++k) {
            double &upper = places[order[k]], &lower = places[order[k + 1]];
            const double missing = height - (lower - upper);
            if (missing <= 0.0) continue;
            upper -= 0.5 * missing;
            lower += 0.5 * missing;
        }
        for (double& place : places) place = std::clamp(place, top, bottom);
    }
}

double y_of(const Axis& axis, const Box2& box, double value) { return box.bottom - axis.place(value) * box.height(); }

class FigureDrawing {
public:
    FigureDrawing(const Figure& figure, Canvas& canvas)
        : figure_(figure),
          canvas_(canvas),
          size_(figure.text_size),
          label_{size_, figure.theme.text},
          tick_{0.86 * size_, figure.theme.faint} {}

    FigurePlaces draw(const Box2& box) {
        canvas_.fill(box, figure_.theme.background, figure_.theme.background.opacity < 1.0 ? 0.6 * size_ : 0.0);
        Box2 inner{box.left + size_, box.top + size_, box.right - size_, box.bottom - size_};
        draw_titles(inner);
        Extent x;
        for (const Panel& panel : figure_.panels)
            for (const Series& series : panel.series)
                for (const double value : series.x) x.add(value);
        make_panel_axes(inner);
        left_ = inner.left + tick_room_ + 0.5 * size_;
        right_ = inner.right - label_room();
        places_.x = Axis::exact(x.empty() ? 0.0 : x.least, x.empty() ? 1.0 : x.most,
                                std::max(2, int((right_ - left_) / (6.0 * size_))));
        const double bottom = inner.bottom - (figure_.x_title.empty() ? 1.6 : 3.2) * size_;
        const double each = (bottom - inner.top) / double(std::max<std::size_t>(1, figure_.panels.size()));
        for (std::size_t k = 0; k < figure_.panels.size(); ++k) {
            const double top = inner.top + double(k) * each;
            draw_panel(
                figure_.panels[k], axes_[k],
                {left_, top + 2.3 * size_, right_, top + each - (k + 1 < figure_.panels.size() ? 0.9 * size_ : 0.0)});
        }
        draw_x_axis(bottom);
        return std::move(places_);
    }

private:
    void draw_titles(Box2& inner) {
        if (!figure_.title.empty()) {
            TextStyle style{1.25 * size_, figure_.theme.text, true};
            canvas_.text({inner.left, inner.top + size_}, figure_.title, style);
            inner.top += 2.0 * size_;
        }
        if (!figure_.subtitle.empty()) {
            canvas_.text({inner.left, inner.top + 0.7 * size_}, figure_.subtitle, {size_, figure_.theme.faint});
            inner.top += 1.9 * size_;
        }
    }

    void make_panel_axes(const Box2& inner) {
        const double height = inner.height() / double(std::max<std::size_t>(1, figure_.panels.size()));
        for (const Panel& panel : figure_.panels) {
            Extent y;
            for (const Series& series : panel.series)
                for (const double value : series.y)
                    if (!panel.logarithmic || value > 0.0) y.add(value);
            axes_.push_back(make_axis(y, panel.logarithmic, std::clamp(int(height / (3.2 * size_)), 2, 6)));
            for (const Axis::Tick& tick : axes_.back().ticks())
                tick_room_ = std::max(tick_room_, canvas_.text_width(tick.label, tick_));
        }
    }

    /// Width of the names of the lines, which stand behind their ends.
    double label_room() const {
        double most = 0.0;
        for (const Panel& panel : figure_.panels)
            if (panel.series.size() > 1)
                for (const Series& series : panel.series)
                    most = std::max(most, canvas_.text_width(series.label, label_));
        return most > 0.0 ? most + 0.8 * size_ : 0.6 * size_;
    }

    double x_of(double value) const { return left_ + places_.x.place(value) * (right_ - left_); }

    void draw_panel(const Panel& panel, const Axis& axis, const Box2& box) {
        canvas_.text({left_ - tick_room_ - 0.5 * size_, box.top - 1.1 * size_}, panel.title, label_);
        for (const Axis::Tick& tick : axis.ticks()) {
            const double y = y_of(axis, box, tick.value);
            const std::array<Point2, 2> line{Point2{box.left, y}, Point2{box.right, y}};
            canvas_.polyline(line, figure_.theme.grid, tick.value == 0.0 ? 1.4 : 0.8);
            TextStyle style = tick_;
            style.anchor = 1.0;
            canvas_.text({box.left - 0.5 * size_, y + 0.3 * size_}, tick.label, style);
        }
        places_.panels.push_back({axis, box});
        draw_lines(panel, axis, box);
        draw_line_labels(panel, axis, box);
    }

    void draw_lines(const Panel& panel, const Axis& axis, const Box2& box) {
        const double width = 0.13 * size_;
        canvas_.clip({box.left - width, box.top - width, box.right + width, box.bottom + width});
        std::vector<Point2> points;
        for (const Series& series : panel.series) {
            points.clear();
            for (std::size_t i = 0; i < series.x.size(); ++i)
                points.push_back({x_of(series.x[i]), y_of(axis, box, series.y[i])});
            const Paint paint{series_color(series.color, figure_.theme.dark)};
            canvas_.polyline(points, paint, width, series.dashed ? 0.5 * size_ : 0.0);
            draw_single_points(points, paint, 2.0 * width);
        }
        canvas_.unclip();
    }

    /// Dots at points without a neighbor, which no line shows.
    void draw_single_points(const std::vector<Point2>& points, const Paint& paint, double radius) {
        const auto has_value = [&](std::size_t i) { return i < points.size() && std::isfinite(points[i].y); };
        for (std::size_t i = 0; i < points.size(); ++i)
            if (has_value(i) && !has_value(i - 1) && !has_value(i + 1)) canvas_.disc(points[i], radius, paint);
    }

    void draw_line_labels(const Panel& panel, const Axis& axis, const Box2& box) {
        if (panel.series.size() < 2) return;
        std::vector<double> places;
        for (const Series& series : panel.series) {
            double last = std::numeric_limits<double>::quiet_NaN();
            for (const double value : series.y)
                if (std::isfinite(y_of(axis, box, value))) last = value;
            places.push_back(std::isfinite(last) ? std::clamp(y_of(axis, box, last), box.top, box.bottom) : box.bottom);
        }
        spread(places, 1.25 * size_, box.top, box.bottom);
        for (std::size_t k = 0; k < panel.series.size(); ++k) {
            TextStyle style = label_;
            style.paint = {series_color(panel.series[k].color, figure_.theme.dark)};
            canvas_.text({box.right + 0.5 * size_, places[k] + 0.35 * size_}, panel.series[k].label, style);
        }
    }

    void draw_x_axis(double bottom) {
        TextStyle style = tick_;
        style.anchor = 0.5;
        for (const Axis::Tick& tick : places_.x.ticks())
            canvas_.text({x_of(tick.value), bottom + 1.4 * size_}, tick.label, style);
        style = label_;
        style.anchor = 0.5;
        canvas_.text({0.5 * (left_ + right_), bottom + 2.9 * size_}, figure_.x_title, style);
    }

    const Figure& figure_;
    Canvas& canvas_;
    double size_;
    TextStyle label_, tick_;
    std::vector<Axis> axes_;
    FigurePlaces places_;
    double tick_room_ = 0.0, left_ = 0.0, right_ = 0.0;
};

}  // namespace

Theme Theme::light() { return {{{255, 255, 255}}, {{34, 38, 46}}, {{104, 110, 122}}, {{226, 229, 235}}}; }
Theme Theme::on_picture() {
    return {{{18, 22, 30}, 0.78}, {{240, 243, 248}}, {{176, 184, 198}}, {{255, 255, 255}, 0.14}, true};
}

Color series_color(std::size_t index, bool on_dark) {
    static constexpr std::array<Color, 7> colors{Color{0, 114, 178},   Color{213, 94, 0},   Color{0, 158, 115},
                                                 Color{204, 121, 167}, Color{86, 180, 233}, Color{176, 141, 0},
                                                 Color{110, 110, 120}};
    static constexpr std::array<Color, 7> light{Color{86, 180, 233},  Color{240, 140, 60},  Color{60, 200, 150},
                                                Color{232, 150, 196}, Color{150, 170, 255}, Color{235, 205, 80},
                                                Color{190, 194, 204}};
    return (on_dark ? light : colors)[index % colors.size()];
}

FigurePlaces draw(const Figure& figure, Canvas& canvas, const Box2& box) {
    return FigureDrawing(figure, canvas).draw(box);
}

double FigurePlaces::x_of(double value) const {
    const Box2& box = panels.front().box;
    return box.left + x.place(value) * box.width();
}

void draw_cursor(const Figure& figure, const FigurePlaces& places, double x, Canvas& canvas, const Point2& corner) {
    const double at = places.x_of(x) - corner.x;
    for (std::size_t k = 0; k < places.panels.size(); ++k) {
        const auto& [axis, box] = places.panels[k];
        const std::array<Point2, 2> line{Point2{at, box.top - corner.y}, Point2{at, box.bottom - corner.y}};
        canvas.polyline(line, figure.theme.faint, 0.1 * figure.text_size);
        for (const Series& series : figure.panels[k].series) {
            const auto value = value_at(series, x);
            if (!value || !std::isfinite(y_of(axis, box, *value))) continue;
            const Point2 dot{at, y_of(axis, box, *value) - corner.y};
            canvas.disc(dot, cursor_dot * figure.text_size, {figure.theme.background.color});
            canvas.disc(dot, 0.75 * cursor_dot * figure.text_size, {series_color(series.color, figure.theme.dark)});
        }
    }
}

}  // namespace tumble
