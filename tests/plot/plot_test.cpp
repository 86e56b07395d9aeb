// Plots: ticks at round values with readable labels, the same bytes each time, and lines where their values are.
#include "plot/axis.h"
#include "plot/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tumble::plot_test {
namespace {

std::vector<std::string> labels(const Axis& axis) {
    std::vector<std::string> all;
    for (const Axis::Tick& tick : axis.ticks()) all.push_back(tick.label);
    return all;
}

using Labels = std::vector<std::string>;

TEST(Axis, HasRoundTicksThatCoverTheValues) {
    EXPECT_EQ(labels(Axis::linear(0.0, 3.0, 6)), (Labels{"0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"}));
    EXPECT_EQ(labels(Axis::linear(-1.2, 0.9, 5)), (Labels{"−1.5", "−1.0", "−0.5", "0", "0.5", "1.0"}));
    EXPECT_EQ(labels(Axis::linear(0.0, 18000.0, 4)),
              (Labels{"0", "5000", "10\u2009000", "15\u2009000", "20\u2009000"}));
    EXPECT_EQ(labels(Axis::linear(0.0, 2e-7, 2)), (Labels{"0", "1·10⁻⁷", "2·10⁻⁷"}));
    for (const double scale : {1e-9, 0.3, 1.0, 7.0, 4e6})
        for (const double shift : {-2.0, 0.0, 5.0}) {
            const double least = scale * (shift - 1.0), most = scale * (shift + 1.3);
            const Axis axis = Axis::linear(least, most, 5);
            EXPECT_LE(axis.least(), least);
            EXPECT_GE(axis.most(), most);
            EXPECT_GE(axis.ticks().size(), 3u);
            EXPECT_LE(axis.ticks().size(), 10u);
        }
}

TEST(Axis, HasARangeForASingleValue) {
    for (const double value : {0.0, 3.0, -2e-5}) {
        const Axis axis = Axis::linear(value, value, 4);
        EXPECT_LT(axis.least(), value);
        EXPECT_GT(axis.most(), value);
    }
}

TEST(Axis, LogarithmicTicksArePowersOfTen) {
    const Axis axis = Axis::logarithmic(3e-4, 20.0, 6);
    EXPECT_EQ(labels(axis), (Labels{"10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹", "10²"}));
    EXPECT_DOUBLE_EQ(axis.place(1e-4), 0.0);
    EXPECT_DOUBLE_EQ(axis.place(0.1), 0.5);
    EXPECT_FALSE(std::isfinite(axis.place(0.0)));
}

Figure ramp() {
    Figure figure;
    figure.title = "Ramp";
    figure.x_title = "time (s)";
    Series series{"a", {}, {}, 0, false};
    for (int i = 0; i <= 100; ++i) {
        series.x.push_back(0.01 * i);
        series.y.push_back(2.0 * series.x.back());
    }
    figure.panels.push_back({"height (m)", false, {series}});
    return figure;
}

std::string file_of(const Figure& figure, Canvas::Format format) {
    Canvas canvas(format, 400.0, 300.0);
    draw(figure, canvas, {0.0, 0.0, 400.0, 300.0});
    return canvas.finish();
}

TEST(Figure, HasTheSameBytesEachTime) {
    for (const auto format : {Canvas::Format::svg, Canvas::Format::pdf, Canvas::Format::png}) {
        const std::string first = file_of(ramp(), format);
        EXPECT_GT(first.size(), 1000u);
        // The ids in an SVG count on from one file of a process to the next.
        if (format != Canvas::Format::svg) {
            EXPECT_EQ(file_of(ramp(), format), first);
        }
    }
}

// By column: the mean row of the bluish pixels, which only the line has; none: not a number.
std::vector<double> rows_of_line(const Image& image) {
    std::vector<double> rows;
    for (int x = 0; x < image.width; ++x) {
        double sum = 0.0, weight = 0.0;
        for (int y = 0; y < image.height; ++y) {
            const double blue = image.at(x, y)[2] - image.at(x, y)[0];
            if (blue < 40.0) continue;
            sum += blue * y;
            weight += blue;
        }
        rows.push_back(weight > 0.0 ? sum / weight : std::numeric_limits<double>::quiet_NaN());
    }
    return rows;
}

TEST(Figure, DrawsALineAtItsValues) {
    Canvas canvas(400, 300, 1.0);
    draw(ramp(), canvas, {0.0, 0.0, 400.0, 300.0});
    const std::vector<double> rows = rows_of_line(canvas.image());
    std::vector<int> columns;
    for (int x = 0; x < 400; ++x)
        if (std::isfinite(rows[std::size_t(x)])) columns.push_back(x);
    ASSERT_GT(columns.size(), 250u);
    // A straight line from the lower left to the upper right: its middle lies halfway between its ends.
    const auto row = [&](std::size_t k) { return rows[std::size_t(columns[k])]; };
    const std::size_t quarter = columns.size() / 4;
    EXPECT_GT(row(quarter) - row(3 * quarter), 50.0);
    EXPECT_NEAR(row(2 * quarter), 0.5 * (row(quarter) + row(3 * quarter)), 1.0);
}

TEST(Figure, LeavesAGapWhereThereIsNoValue) {
    Figure figure = ramp();
    for (std::size_t i = 40; i <= 60; ++i) figure.panels[0].series[0].y[i] = std::numeric_limits<double>::quiet_NaN();
    Canvas canvas(400, 300, 1.0);
    draw(figure, canvas, {0.0, 0.0, 400.0, 300.0});
    const std::vector<double> rows = rows_of_line(canvas.image());
    int first = 400, last = 0, found = 0;
    for (int x = 0; x < 400; ++x)
        if (std::isfinite(rows[std::size_t(x)])) first = std::min(first, x), last = std::max(last, x), ++found;
    EXPECT_NEAR(double(found) / (last - first), 0.78, 0.04);
}

TEST(Figure, DrawsADotWhereAValueHasNoNeighbors) {
    Figure figure = ramp();
    Series& series = figure.panels[0].series[0];
    for (std::size_t i = 0; i < series.y.size(); ++i)
        if (i % 10 != 5) series.y[i] = std::numeric_limits<double>::quiet_NaN();
    Canvas canvas(400, 300, 1.0);
    draw(figure, canvas, {0.0, 0.0, 400.0, 300.0});
    int dots = 0;
    bool before = false;
    for (const double row : rows_of_line(canvas.image())) {
        dots += std::isfinite(row) && !before ? 1 : 0;
        before = std::isfinite(row);
    }
    EXPECT_EQ(dots, 10);
}

TEST(Figure, CursorMarksTheValueAtItsTime) {
    const Figure figure = ramp();
    Canvas with(400, 300, 1.0), without(400, 300, 1.0);
    const FigurePlaces places = draw(figure, with, {0.0, 0.0, 400.0, 300.0});
    draw_cursor(figure, places, 0.25, with, {0.0, 0.0});
    draw(figure, without, {0.0, 0.0, 400.0, 300.0});
    const Image a = with.image(), b = without.image();
    int changed = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4) changed += a.pixels[i] != b.pixels[i];
    EXPECT_GT(changed, 100);   // the line and the dot
    EXPECT_LT(changed, 1500);  // and nothing else
    // On a canvas that shows a part of the figure, it is at the same place of the figure.
    const int left = int(places.x_of(0.25)) - 20;
    Canvas strip(40, 300, 1.0), whole(400, 300, 1.0);
    draw_cursor(figure, places, 0.25, strip, {double(left), 0.0});
    draw_cursor(figure, places, 0.25, whole, {0.0, 0.0});
    const Image part = strip.image(), all = whole.image();
    for (int y = 0; y < 300; ++y) EXPECT_TRUE(std::equal(part.at(0, y), part.at(0, y) + 160, all.at(left, y))) << y;
}

}  // namespace
}  // namespace tumble::plot_test
