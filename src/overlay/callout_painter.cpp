#include "overlay/callout_painter.h"

#include "plot/canvas.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace tumble {
namespace {

// In units of sizes on the screen.
constexpr double frame_margin = 6.0;  // between a text and the edge of the picture
constexpr double gap = 4.0;           // between two texts
constexpr double fading = 24.0;       // from the edge of the picture, in which a callout becomes visible
constexpr double dot = 3.2;           // radius, at the point
constexpr double line_width = 1.8;
// In sizes of the letters.
constexpr double line_height = 1.25, ascent = 0.95, padding = 0.35;
constexpr double ground_opacity = 0.62;

constexpr double nearest_point = 1e-3;      // of the distance to the camera's target: nearer points are not drawn
constexpr std::size_t most_pictures = 512;  // texts with numbers change in each frame

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    for (std::size_t first = 0; first <= text.size();) {
        const std::size_t end = std::min(text.find('\n', first), text.size());
        lines.push_back(text.substr(first, end - first));
        first = end + 1;
    }
    return lines;
}

bool on_screen(const Eigen::Vector2d& pixel) { return std::fabs(pixel.x()) < 1e6 && std::fabs(pixel.y()) < 1e6; }

bool meet(const Rectangle& a, const Rectangle& b, int distance) {
    return a.x < b.x + b.width + distance && b.x < a.x + a.width + distance && a.y < b.y + b.height + distance &&
           b.y < a.y + a.height + distance;
}

}  // namespace

std::optional<PlacedCallout> CalloutPainter::placed(const Camera& camera, const OverlayCallout& callout) {
    const double least = nearest_point * camera.target_distance();
    const Vec3 of = camera.relative(callout.of), at = camera.relative(callout.at);
    if (of.dot(camera.forward()) < least || at.dot(camera.forward()) < least) return std::nullopt;
    PlacedCallout placed{&callout, {camera.pixel(of), of.dot(camera.forward())}, {}, 1.0};
    const Eigen::Vector2d& point = placed.of.pixel;
    const Eigen::Vector2d place = camera.pixel(at);
    if (!on_screen(point) || !on_screen(place)) return std::nullopt;
    const double inside = std::min({point.x(), point.y(), width_ - point.x(), height_ - point.y()});
    if (inside <= 0.0) return std::nullopt;
    placed.opacity = std::min(1.0, inside / (fading * unit_));
    const Image& text = picture(callout);
    const int edge = int(std::lround(frame_margin * unit_));
    const auto kept = [&](double wanted, int size, int whole) {
        return std::max(edge, std::min(int(std::floor(wanted + 0.5)), whole - edge - size));
    };
    placed.box = {kept(place.x() - 0.5 * text.width, text.width, width_),
                  kept(place.y() - callout.lift * unit_ - text.height, text.height, height_), text.width, text.height};
    return placed;
}

/// Upwards, or where there is no space down, just past each text that it meets.
void CalloutPainter::move_off(const std::vector<PlacedCallout>& before, Rectangle& box) const {
    const int space = int(std::lround(gap * unit_)), edge = int(std::lround(frame_margin * unit_));
    const auto blocking = [&](const Rectangle& tried) {
        return std::ranges::find_if(before, [&](const PlacedCallout& other) { return meet(tried, other.box, space); });
    };
    for (const bool up : {true, false}) {
        Rectangle tried = box;
        // Each step passes one of them for good.
        for (auto other = blocking(tried); other != before.end(); other = blocking(tried))
            tried.y = up ? other->box.y - space - tried.height : other->box.y + other->box.height + space;
        if (tried.y < edge || tried.y + tried.height > height_ - edge) continue;
        box = tried;
        return;
    }
}

std::vector<PlacedCallout> CalloutPainter::place(const Camera& camera, const std::vector<OverlayCallout>& callouts) {
    std::vector<PlacedCallout> shown;
    for (const OverlayCallout& callout : callouts) {
        std::optional<PlacedCallout> one = placed(camera, callout);
        if (!one) continue;
        move_off(shown, one->box);
        shown.push_back(*one);
    }
    return shown;
}

void CalloutPainter::draw(const Camera& camera, const std::vector<OverlayCallout>& callouts, ShapeRaster& raster) {
    if (callouts.empty()) return;
    if (pictures_.size() > most_pictures) pictures_.clear();
    const std::vector<PlacedCallout> shown = place(camera, callouts);
    for (const PlacedCallout& one : shown) {
        if (!one.callout->leader) continue;
        const OverlayPaint paint{one.callout->color, float(one.opacity), false};
        const double bottom = one.box.y + one.box.height;
        const double x = std::clamp(one.of.pixel.x(), one.box.x + 0.2 * one.box.width, one.box.x + 0.8 * one.box.width);
        const bool below = one.of.pixel.y() >= bottom;
        if (below || one.of.pixel.y() <= one.box.y)
            raster.line(std::array{one.of, ScreenPoint{{x, below ? bottom : double(one.box.y)}, one.of.depth}},
                        line_width * unit_, paint);
        raster.marker(one.of, dot * unit_, MarkerShape::disc, paint);
    }
    for (const PlacedCallout& one : shown) raster.picture(picture(*one.callout), one.box.x, one.box.y, one.opacity);
}

const Image& CalloutPainter::picture(const OverlayCallout& callout) {
    const Color color = callout.color;
    const auto [found, added] = pictures_.try_emplace({callout.text, callout.size, {color.r, color.g, color.b}});
    if (!added) return found->second;
    const double size = callout.size, edge = padding * size;
    TextStyle style;
    style.size = size;
    style.paint = {color, 1.0};
    style.anchor = 0.5;
    const std::vector<std::string_view> lines = lines_of(callout.text);
    const Canvas measure(1, 1, 1.0);
    double width = 0.0;
    for (const std::string_view line : lines) width = std::max(width, measure.text_width(line, style));
    width += 2.0 * edge;
    const double height = line_height * size * double(lines.size()) + edge;
    Canvas canvas(int(std::ceil(width * unit_)), int(std::ceil(height * unit_)), unit_);
    canvas.fill({0.0, 0.0, width, height}, {style::label_background_color, ground_opacity}, edge);
    for (std::size_t i = 0; i < lines.size(); ++i)
        canvas.text({0.5 * width, 0.5 * edge + (line_height * double(i) + ascent) * size}, lines[i], style);
    return found->second = canvas.image();
}

}  // namespace tumble
