#include "render/touched_area.h"

#include "render/plane_axes.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double filter_texels = 6.0;   // the shadow filter's width and the normal's offset, with some to spare

// Grows an area by disks that lie in the plane.
class Collector {
public:
    Collector(const Vec3& normal, const CameraView& view) : view_(view), axes_(plane_axes(normal)) {}

    void add_disk(const Vec3& center, double radius) {
        for (const double a : {-radius, radius})
            for (const double b : {-radius, radius}) add_point(center + a * axes_.u + b * axes_.v);
    }

    void add_everything() { everything_ = true; }

    PixelArea area() const {
        if (everything_) return {0, 0, view_.width(), view_.height()};
        if (x0_ > x1_) return {};
        const auto clamped = [](double value, int most) { return int(std::clamp(value, 0.0, double(most))); };
        return {clamped(std::floor(x0_) - 2.0, view_.width()), clamped(std::floor(y0_) - 2.0, view_.height()),
                clamped(std::ceil(x1_) + 2.0, view_.width()), clamped(std::ceil(y1_) + 2.0, view_.height())};
    }

private:
    void add_point(const Vec3& p) {
        const double depth = p.dot(view_.forward());
        if (!(depth > 1e-3 * p.norm())) {   // beside or behind the eye: its place on the screen means nothing
            everything_ = true;
            return;
        }
        const Eigen::Vector2d at = view_.pixel(p);
        x0_ = std::min(x0_, at.x());
        x1_ = std::max(x1_, at.x());
        y0_ = std::min(y0_, at.y());
        y1_ = std::max(y1_, at.y());
    }

    const CameraView& view_;
    PlaneAxes axes_;
    bool everything_ = false;
    double x0_ = std::numeric_limits<double>::infinity(), x1_ = -x0_, y0_ = x0_, y1_ = -x0_;
};

}  // namespace

PixelArea touched_area(const PlanePatch& plane, const SceneDescription& scene, const SceneLooks& looks,
                       const Snapshot& snapshot, const CameraView& view, const ShadowFit& shadows) {
    const Vec3 light = scene.light.direction.normalized();
    const double approach = -plane.normal.dot(light);   // of the light to the plane, sine of its elevation
    const double margin = filter_texels * (shadows.has_far ? shadows.far_texel : shadows.near_texel);
    Collector collector(plane.normal, view);
    if (scene.light.shadows && !scene.cords.empty()) collector.add_everything();   // cords are long: not worth a bound
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        const BodyLook& look = looks.bodies[i];
        if (look.kind == DrawKind::hidden || look.kind == DrawKind::plane) continue;
        const BoundingBall ball = bounding_ball(look, snapshot.bodies[i], view);
        const double height = plane.normal.dot(ball.center) + plane.height;
        if (height < -ball.radius) continue;
        if (height < ball.radius + 2.0 * look.reach && view.sees(ball.center, ball.radius + 2.0 * look.reach))
            collector.add_disk(ball.center - height * plane.normal, ball.radius + 2.0 * look.reach);
        if (scene.light.shadows && approach > 0.0 && view.sees_swept(ball.center, ball.radius, light)) {
            if (approach < 0.02) collector.add_everything();   // shadows without end
            else collector.add_disk(ball.center + light * (height / approach), (ball.radius + margin) / approach);
        }
    }
    return collector.area();
}

}  // namespace tumble
