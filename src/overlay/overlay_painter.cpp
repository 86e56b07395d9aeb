#include "overlay/overlay_painter.h"

#include "plot/canvas.h"
#include "render/shapes/drawn_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace tumble {
namespace {

constexpr double nearest = 1e-3;  // of the distance to the camera's target: nearer parts of lines are cut off
constexpr std::size_t most_kept_pixels = 4 << 20;  // of ghosts: 48 MiB in each render process
constexpr double margin = 14.0;                    // of the legend, in units of the shapes' sizes
constexpr Color damage_color{255, 64, 200};

ScreenPoint project(const Camera& camera, const Vec3& relative) {
    return {camera.pixel(relative), relative.dot(camera.forward())};
}

/// Cuts off the part of a line behind the nearest depth. False: nothing is left. Positions relative to the eye.
bool cut(const Camera& camera, Vec3& from, Vec3& to) {
    const double least = nearest * camera.target_distance();
    const double a = from.dot(camera.forward()), b = to.dot(camera.forward());
    if (a < least && b < least) return false;
    if (a < least) from += (least - a) / (b - a) * (to - from);
    if (b < least) to += (least - b) / (a - b) * (from - to);
    return true;
}

void copy(const Image& from, Image& to, const Rectangle& r) {
    for (int y = r.y; y < r.y + r.height; ++y) std::memcpy(to.at(r.x, y), from.at(r.x, y), std::size_t(r.width) * 4);
}

}  // namespace

OverlayPainter::OverlayPainter(const SceneDescription& scene, const PanelOverlay& overlay)
    : scene_(&scene),
      unit_(overlay_unit(scene.output.height)),
      raster_(scene.output.width, scene.output.height,
              Camera(scene.camera, scene.output.width, scene.output.height).pixel_size()),
      callouts_(scene.output.width, scene.output.height, unit_),
      legend_top_(overlay.legend_top),
      image_(scene.output.width, scene.output.height),
      previous_(scene.output.width, scene.output.height) {
    if (overlay.legend) legend_ = draw_legend(scene, overlay);
}

const Image& OverlayPainter::draw(const PlainFrame& frame, const OverlayFrame& shapes) {
    TouchedTiles dirty = previous_;
    if (first_) dirty.add(Rectangle{0, 0, image_.width, image_.height});
    for (const Rectangle& r : frame.changed) dirty.add(r);
    for (const Rectangle& r : dirty.rectangles()) copy(frame.image, image_, r);
    if (frame.camera.eye() != ghost_eye_ || frame.camera.clip_from_relative(1.0) != ghost_view_) {
        ghosts_.clear();
        ghost_pixels_ = 0;
    }
    ghost_eye_ = frame.camera.eye();
    ghost_view_ = frame.camera.clip_from_relative(1.0);
    raster_.begin(image_, &frame.depths);
    draw_shapes(frame.camera, shapes);
    if (shapes.damage)
        for (const Rectangle& r : frame.changed) raster_.outline(r, {damage_color, 0.85, false});
    if (shapes.legend && legend_) raster_.picture(*legend_, int(margin * unit_), legend_top_, 1.0);
    dirty.add(raster_.touched());
    changed_ = dirty.rectangles();
    previous_ = raster_.touched();
    first_ = false;
    return image_;
}

void OverlayPainter::draw_shapes(const Camera& camera, const OverlayFrame& shapes) {
    for (const OverlaySurface& surface : shapes.surfaces) draw_surface(camera, surface);
    for (const OverlayLine& line : shapes.lines) draw_line(camera, line);
    for (const OverlayArrow& arrow : shapes.arrows) {
        Vec3 from = camera.relative(arrow.from), to = camera.relative(arrow.to);
        if (!cut(camera, from, to)) continue;
        raster_.arrow({project(camera, from), project(camera, to), arrow.width * unit_, arrow.double_head ? 2 : 1},
                      arrow.paint);
    }
    for (const OverlayMarker& marker : shapes.markers) {
        const Vec3 at = camera.relative(marker.at);
        if (at.dot(camera.forward()) < nearest * camera.target_distance()) continue;
        raster_.marker(project(camera, at), marker.radius * unit_, marker.shape, marker.paint);
    }
    for (const OverlayLabel& label : shapes.labels) draw_label(camera, label);
    callouts_.draw(camera, shapes.callouts, raster_);
}

// Parts behind the eye are cut out, which may leave several lines.
void OverlayPainter::draw_line(const Camera& camera, const OverlayLine& line) {
    const auto finish = [&] {
        raster_.line(points_, line.width * unit_, line.paint);
        points_.clear();
    };
    points_.clear();
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
        Vec3 from = camera.relative(line.points[i]), to = camera.relative(line.points[i + 1]);
        const Vec3 whole_to = to;
        if (!cut(camera, from, to)) continue;
        if (points_.empty()) points_.push_back(project(camera, from));
        points_.push_back(project(camera, to));
        if (to != whole_to) finish();
    }
    finish();
}

// While the camera stands still, ghosts keep their pixels.
void OverlayPainter::draw_surface(const Camera& camera, const OverlaySurface& surface) {
    if (!surface.shaded) {
        raster_.surface(cover(camera, surface), surface.paint.opacity);
        return;
    }
    const auto& q = surface.orientation.coeffs();
    const std::array<double, 8> key{
        double(surface.body), surface.origin.x(), surface.origin.y(), surface.origin.z(), q[0], q[1], q[2], q[3]};
    if (const auto kept = ghosts_.find(key); kept != ghosts_.end())
        return raster_.surface(kept->second, surface.paint.opacity);
    SurfaceCover ghost = cover(camera, surface);
    raster_.surface(ghost, surface.paint.opacity);
    if (ghost_pixels_ + ghost.pixels.size() > most_kept_pixels) return;
    ghost_pixels_ += ghost.pixels.size();
    ghosts_.emplace(key, std::move(ghost));
}

// Ghosts are lit from the eye and from above.
SurfaceCover OverlayPainter::cover(const Camera& camera, const OverlaySurface& surface) {
    corners_.clear();
    const Vec3 center = camera.relative(surface.origin);
    const Mat3 rotation = surface.orientation.toRotationMatrix();
    const Vec3 light = (Vec3(0.0, 1.0, 0.0) - style::ghost_light_from_eye * camera.forward()).normalized();
    const double least = nearest * camera.target_distance();
    const Triangles& all = triangles(surface.body);
    for (std::size_t i = 0; i + 2 < all.size(); i += 3) {
        std::array<ScreenCorner, 3> triangle;
        bool in_front = true;
        for (std::size_t k = 0; k < 3 && in_front; ++k) {
            const Vec3 place = center + rotation * all[i + k].position;
            in_front = place.dot(camera.forward()) > least;
            if (in_front)
                triangle[k] = {project(camera, place),
                               surface.shaded
                                   ? style::ghost_ambient + (1.0 - style::ghost_ambient) *
                                                                std::max(0.0, (rotation * all[i + k].normal).dot(light))
                                   : 1.0,
                               surface.shaded ? all[i + k].color : surface.paint.color};
        }
        if (in_front) corners_.insert(corners_.end(), triangle.begin(), triangle.end());
    }
    return raster_.cover(corners_);
}

void OverlayPainter::add_shape(const Shape& shape, const Vec3& origin, const Quat& rotation, Color color,
                               Triangles& to) {
    if (const auto* compound = std::get_if<CompoundShape>(&shape)) {
        for (const CompoundPart& part : *compound->parts)
            if (part.visible)
                add_shape(part.shape, origin + rotation * part.position, rotation * part.rotation,
                          part.color.value_or(color), to);
        return;
    }
    for (const SurfaceCorner& corner : std::visit([](const auto& one) { return surface_triangles(one); }, shape))
        to.push_back({origin + rotation * corner.position, rotation * corner.normal, color});
}

const OverlayPainter::Triangles& OverlayPainter::triangles(std::size_t body) {
    const auto [found, added] = triangles_.try_emplace(body);
    const BodyDescription& description = scene_->bodies[body];
    if (added)
        add_shape(description.shape, Vec3::Zero(), Quat::Identity(), description.appearance.color, found->second);
    return found->second;
}

void OverlayPainter::draw_label(const Camera& camera, const OverlayLabel& label) {
    const Vec3 at = camera.relative(label.at);
    if (at.dot(camera.forward()) < nearest * camera.target_distance()) return;
    const Eigen::Vector2d pixel = camera.pixel(at);
    const Image& text = text_picture(label);
    if (!(std::fabs(pixel.x()) < 1e6 && std::fabs(pixel.y()) < 1e6)) return;
    raster_.picture(text, int(std::floor(pixel.x() - 0.5 * text.width + 0.5)),
                    int(std::floor(pixel.y() - text.height + 0.5)), label.paint.opacity);
}

const Image& OverlayPainter::text_picture(const OverlayLabel& label) {
    const auto [found, added] = texts_.try_emplace({label.text, label.size});
    if (!added) return found->second;
    TextStyle style;
    style.size = label.size;
    style.paint = {label.paint.color, 1.0};
    style.anchor = 0.5;
    const double width = Canvas(1, 1, 1.0).text_width(label.text, style) + 0.9 * label.size, height = 1.5 * label.size;
    Canvas canvas(int(std::ceil(width * unit_)), int(std::ceil(height * unit_)), unit_);
    canvas.fill({0.0, 0.0, width, height}, {style::label_background_color, 0.6}, 0.35 * label.size);
    canvas.text({0.5 * width, 1.08 * label.size}, label.text, style);
    return found->second = canvas.image();
}

}  // namespace tumble
