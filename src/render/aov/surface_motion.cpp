#include "render/aov/surface_motion.h"
#include "core/vector.h"

#include <limits>

namespace tumble {
namespace {

FrameMotion between(const PartPlace& now, const PartPlace& next) {
    const Mat3 turn = next.axes * now.axes.transpose();
    return {turn, next.origin - turn * now.origin};
}

/// A cord stays attached at both ends; offsets perpendicular to it only rotate with it.
FrameMotion between(const CordPlace& now, const CordPlace& next) {
    const Mat3 turn = rotation_between(now.to - now.from, next.to - next.from).toRotationMatrix();
    return {turn, next.from - turn * now.from};
}

PartPlace world_in(const PinholeCamera& camera) { return {camera.axes.transpose(), camera.from_world(Vec3::Zero())}; }

}  // namespace

SurfaceMotion::SurfaceMotion(const ScenePlaces& now, const PinholeCamera& camera, const ScenePlaces& next,
                             const PinholeCamera& next_camera)
    : cords_now_(now.cords),
      cords_next_(next.cords),
      parts_(now.parts.size()),
      camera_rests_(camera == next_camera),
      camera_turn_(next_camera.axes.transpose() * camera.axes),
      next_camera_(next_camera) {
    const auto add = [&](const auto& from, const auto& to) {
        for (std::size_t i = 0; i < from.size(); ++i) {
            rests_.push_back(camera_rests_ && from[i] == to[i] ? 1 : 0);
            surfaces_.push_back(between(from[i], to[i]));
        }
    };
    add(now.parts, next.parts);
    add(now.cords, next.cords);
    rests_.push_back(camera_rests_ ? 1 : 0);
    surfaces_.push_back(between(world_in(camera), world_in(next_camera)));
}

Eigen::Vector2d SurfaceMotion::of_surface(std::uint32_t surface, const Vec3& point, int column, int row) const {
    const FrameMotion& motion = surfaces_[surface];
    Vec3 next = motion.turn * point + motion.shift;
    if (surface >= parts_ && surface < parts_ + cords_now_.size()) {
        // A cord that gets longer displaces each point by its share of the length.
        const CordPlace &a = cords_now_[surface - parts_], &b = cords_next_[surface - parts_];
        const Vec3 along = a.to - a.from;
        const double share = along.dot(point - a.from) / along.squaredNorm();
        next += share * ((b.to - b.from) - motion.turn * along);
    }
    return to(next, column, row);
}

Eigen::Vector2d SurfaceMotion::of_nothing(const Vec3& ray, int column, int row) const {
    return to(camera_turn_ * ray, column, row);
}

Eigen::Vector2d SurfaceMotion::to(const Vec3& next_point, int column, int row) const {
    if (!(next_point.z() > 0.0)) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    const PinholeCamera& c = next_camera_;
    return {c.focal * next_point.x() / next_point.z() + (c.center_x - column),
            c.focal * next_point.y() / next_point.z() + (c.center_y - row)};
}

}  // namespace tumble
