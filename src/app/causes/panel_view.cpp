#include "app/causes/panel_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

constexpr double near_plane = 1e-3;  // part of the distance to the target: nearer points have no place on the screen

CameraDescription description_of(const RecordedView& view) {
    CameraDescription camera;
    camera.eye = view.eye;
    camera.target = view.target;
    camera.up = view.up;
    camera.vertical_fov = view.vertical_fov;
    return camera;
}

std::array<Vec3, 8> corners_of(const Bounds& b) {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i)
        corners[i] = {(i & 1 ? b.max : b.min).x(), (i & 2 ? b.max : b.min).y(), (i & 4 ? b.max : b.min).z()};
    return corners;
}

Vec3 world(const RecordedPose& pose, const Vec3& point) { return pose.origin + pose.rotation * point; }

}  // namespace

PanelView::PanelView(const PanelRecord& panel, std::size_t recorded, const Rectangle& changed)
    : panel_(panel),
      recorded_(recorded),
      changed_(changed),
      camera_(description_of(panel.views[recorded]), std::max(panel.place.width, 1), std::max(panel.place.height, 1)) {
    std::size_t moving = 0;
    for (const RecordedBody& body : panel.bodies) moving_index_.push_back(body.moves ? moving++ : 0);
}

const RecordedPose& PanelView::pose(std::size_t body) const {
    return panel_.bodies[body].moves ? panel_.poses[recorded_][moving_index_[body]] : panel_.start[body];
}

std::optional<Eigen::Vector2d> PanelView::pixel(const Vec3& point) const {
    const Vec3 relative = camera_.relative(point);
    if (!(relative.dot(camera_.forward()) > near_plane * camera_.target_distance())) return std::nullopt;
    return camera_.pixel(relative);
}

Rectangle PanelView::bounds(std::size_t body) const {
    const Rectangle& place = panel_.place;
    const Bounds& shape = panel_.kind_of(body).bounds;
    if (shape.empty()) return place;
    Eigen::Vector2d min(infinity, infinity), max(-infinity, -infinity);
    bool behind = false, before = false;
    for (const Vec3& corner : corners_of(shape)) {
        const auto p = pixel(world(pose(body), corner));
        (p ? before : behind) = true;
        if (!p) continue;
        min = min.cwiseMin(*p);
        max = max.cwiseMax(*p);
    }
    if (!before) return {};
    if (behind) return place;
    const double left = std::clamp(std::floor(min.x()), 0.0, double(place.width));
    const double right = std::clamp(std::ceil(max.x()), 0.0, double(place.width));
    const double top = std::clamp(std::floor(min.y()), 0.0, double(place.height));
    const double bottom = std::clamp(std::ceil(max.y()), 0.0, double(place.height));
    if (!(left < right && top < bottom)) return {};
    return {place.x + int(left), place.y + int(top), int(right - left), int(bottom - top)};
}

double PanelView::changed_pixels(std::size_t body) const {
    const Rectangle r = bounds(body);
    if (changed_.width == 0) return double(r.width) * r.height;
    const int width = std::min(r.x + r.width, changed_.x + changed_.width) - std::max(r.x, changed_.x);
    const int height = std::min(r.y + r.height, changed_.y + changed_.height) - std::max(r.y, changed_.y);
    return width > 0 && height > 0 ? double(width) * height : 0.0;
}

double PanelView::distance(std::size_t body, const RecordedPose& a, const RecordedPose& b) const {
    const BodyKind& kind = panel_.kind_of(body);
    if (kind.round || kind.bounds.empty()) return center_distance(body, a, b);
    double largest = 0.0;
    for (const Vec3& corner : corners_of(kind.bounds)) {
        const auto p = pixel(world(a, corner)), q = pixel(world(b, corner));
        if (!p || !q) return infinity;
        largest = std::max(largest, (*p - *q).norm());
    }
    return largest;
}

double PanelView::center_distance(std::size_t body, const RecordedPose& a, const RecordedPose& b) const {
    const Bounds& shape = panel_.kind_of(body).bounds;
    const Vec3 center = shape.empty() ? Vec3(Vec3::Zero()) : shape.center();
    const auto p = pixel(world(a, center)), q = pixel(world(b, center));
    return p && q ? (*p - *q).norm() : infinity;
}

std::optional<std::size_t> recorded_index(const MotionRecord& record, std::int64_t frame) {
    const auto place = std::ranges::lower_bound(record.frames, frame);
    if (place == record.frames.end() || *place != frame) return std::nullopt;
    return std::size_t(place - record.frames.begin());
}

}  // namespace tumble
