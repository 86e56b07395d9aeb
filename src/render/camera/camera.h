// The pinhole camera: the pixel of a world point, and the bounds of the view.
// With e the eye, unit axes r (right), u (up), f (forward), and t = tan(vertical_fov / 2), a = width / height:
//   x_pixel = width  / 2 (1 + (p-e).r / (a t (p-e).f))
//   y_pixel = height / 2 (1 - (p-e).u / (  t (p-e).f))      counted from the top left corner of the picture.
// Positions are relative to the eye, subtracted here in double precision.
#pragma once

#include "core/vector.h"
#include "scene/description/description.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <limits>

namespace tumble {

class Camera {
public:
    /// `shift`, in pixels, moves the whole image: the mean of several shifted images has smooth edges.
    Camera(const CameraDescription& camera, int width, int height,
           const Eigen::Vector2d& shift = Eigen::Vector2d::Zero());

    /// The same camera at another place, with the same scale of patterns and fog.
    Camera from(const CameraDescription& camera) const;

    const Vec3& eye() const { return eye_; }
    const Vec3& right() const { return right_; }
    const Vec3& up() const { return up_; }
    const Vec3& forward() const { return forward_; }
    int width() const { return width_; }
    int height() const { return height_; }

    /// The same camera from another point of its lens, in m to the right of the eye and above it: points at
    /// the distance `focus` (m, along the view) stay at their pixels.
    Camera through(const Eigen::Vector2d& point, double focus) const;

    /// Distance from eye to target, m: a length scale of the view.
    double target_distance() const { return target_distance_; }

    /// Reference distance of patterns, and distance at which fog is half of a body's light, m; constant over a clip.
    /// Default: the distance to the target, and no fog.
    double viewing_distance() const { return viewing_distance_; }
    double fog_distance() const { return fog_distance_; }
    Camera with_distances(double viewing, double fog) const;

    /// The width of a pixel at distance 1 along the axis.
    double pixel_size() const { return 2.0 * tan_y_ / height_; }

    Vec3 relative(const Vec3& world) const { return world - eye_; }

    /// Pixels from the top left corner, of a point in front of the eye. `relative`: m, from the eye.
    Eigen::Vector2d pixel(const Vec3& relative) const;

    /// The ray through a point of the image (pixels from the top left corner), with length 1 along the view axis.
    Vec3 ray(double x, double y) const;

    /// Inward unit normals of the four side planes of the view frustum, all through the eye.
    const std::array<Vec3, 4>& sides() const { return sides_; }

    /// True if a ball (relative to the eye) may be visible.
    bool sees(const Vec3& center, double radius) const;

    /// True if a ball's shadow, cast along a direction, may be visible.
    bool sees_swept(const Vec3& center, double radius, const Vec3& direction) const;

    /// Relative position to clip space, with a near plane at this distance and an infinite far plane. The first row of
    /// the image is at y = -1, so that glReadPixels delivers it first.
    glm::mat4 clip_from_relative(double near_distance) const;

private:
    void set_sides();

    Vec3 eye_, right_, up_, forward_;
    double target_distance_, viewing_distance_;
    double fog_distance_ = std::numeric_limits<double>::infinity();
    int width_, height_;
    double tan_x_, tan_y_;
    Eigen::Vector2d shift_;  // pixels
    std::array<Vec3, 4> sides_;
};

}  // namespace tumble
