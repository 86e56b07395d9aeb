#include "render/camera/camera.h"

#include "core/deterministic_math.h"

#include <cmath>

namespace tumble {
namespace {

// The world axis with the largest angle to a direction.
Vec3 most_across(const Vec3& direction) {
    Vec3::Index smallest = 0;
    direction.cwiseAbs().minCoeff(&smallest);
    return Vec3::Unit(smallest);
}

}  // namespace

Camera::Camera(const CameraDescription& camera, int width, int height, const Eigen::Vector2d& shift)
    : eye_(camera.eye), width_(width), height_(height), shift_(shift) {
    const Vec3 to_target = camera.target - camera.eye;
    target_distance_ = to_target.norm();
    if (!(target_distance_ > 0.0)) target_distance_ = 1.0;  // an eye at its target looks along -z
    forward_ = to_target.norm() > 0.0 ? Vec3(to_target / target_distance_) : Vec3(0.0, 0.0, -1.0);
    right_ = forward_.cross(camera.up);
    viewing_distance_ = target_distance_;
    // An up vector parallel to the view (a camera straight from above) leaves the roll undefined: any perpendicular
    // axis is valid.
    if (!(right_.norm() > 1e-9 * camera.up.norm())) right_ = forward_.cross(most_across(forward_));
    right_.normalize();
    up_ = right_.cross(forward_);

    const SinCos half = sincos(0.5 * camera.vertical_fov * pi / 180.0);
    tan_y_ = half.sin / half.cos;
    tan_x_ = tan_y_ * width / height;
    set_sides();
}

void Camera::set_sides() {
    const double x = 2.0 * shift_.x() / width_, y = 2.0 * shift_.y() / height_;
    sides_ = {(right_ + tan_x_ * (1.0 + x) * forward_).normalized(),
              (-right_ + tan_x_ * (1.0 - x) * forward_).normalized(),
              (up_ + tan_y_ * (1.0 - y) * forward_).normalized(), (-up_ + tan_y_ * (1.0 + y) * forward_).normalized()};
}

Camera Camera::through(const Eigen::Vector2d& point, double focus) const {
    Camera view = *this;
    view.eye_ += right_ * point.x() + up_ * point.y();
    view.shift_ +=
        Eigen::Vector2d(0.5 * width_ * point.x() / (tan_x_ * focus), -0.5 * height_ * point.y() / (tan_y_ * focus));
    view.set_sides();
    return view;
}

Camera Camera::from(const CameraDescription& camera) const {
    Camera view(camera, width_, height_, shift_);
    view.viewing_distance_ = viewing_distance_;
    view.fog_distance_ = fog_distance_;
    return view;
}

Camera Camera::with_distances(double viewing, double fog) const {
    Camera view = *this;
    view.viewing_distance_ = viewing;
    view.fog_distance_ = fog;
    return view;
}

Eigen::Vector2d Camera::pixel(const Vec3& relative) const {
    const double depth = relative.dot(forward_);
    return {0.5 * width_ * (1.0 + relative.dot(right_) / (tan_x_ * depth)) + shift_.x(),
            0.5 * height_ * (1.0 - relative.dot(up_) / (tan_y_ * depth)) + shift_.y()};
}

Vec3 Camera::ray(double x, double y) const {
    return forward_ + right_ * (tan_x_ * (2.0 * (x - shift_.x()) / width_ - 1.0)) +
           up_ * (tan_y_ * (1.0 - 2.0 * (y - shift_.y()) / height_));
}

bool Camera::sees(const Vec3& center, double radius) const {
    if (center.dot(forward_) < -radius) return false;
    for (const Vec3& side : sides_)
        if (center.dot(side) < -radius) return false;
    return true;
}

bool Camera::sees_swept(const Vec3& center, double radius, const Vec3& direction) const {
    for (const Vec3& side : sides_)
        if (center.dot(side) < -radius && direction.dot(side) <= 0.0) return false;
    return true;
}

glm::mat4 Camera::clip_from_relative(double near_distance) const {
    // rows: r / tan_x, -u / tan_y, f w/ z = w - 2 near, f
    glm::mat4 m(0.0f);
    for (int i = 0; i < 3; ++i) {
        m[i][0] = float(right_[i] / tan_x_ + forward_[i] * 2.0 * shift_.x() / width_);
        m[i][1] = float(-up_[i] / tan_y_ + forward_[i] * 2.0 * shift_.y() / height_);
        m[i][2] = float(forward_[i]);
        m[i][3] = float(forward_[i]);
    }
    m[3][2] = float(-2.0 * near_distance);
    return m;
}

}  // namespace tumble
