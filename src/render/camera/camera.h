// The pinhole camera: where a point of the world lands on the screen, and what is in view at all.
// With e the eye, unit axes r (right), u (up), f (forward), and t = tan(vertical_fov / 2), a = width / height:
//   x_pixel = width  / 2 (1 + (p-e).r / (a t (p-e).f))
//   y_pixel = height / 2 (1 - (p-e).u / (  t (p-e).f))      counted from the top left corner of the picture.
// Positions are handed on relative to the eye, subtracted here in double precision.
#pragma once

#include "core/vector.h"
#include "scene/description/description.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <limits>

namespace tumble {

class Camera {
public:
    /// `shift`, in pixels, moves the whole picture: averages of many small ones have smooth edges.
    Camera(const CameraDescription& camera, int width, int height,
               const Eigen::Vector2d& shift = Eigen::Vector2d::Zero());

    /// The same picture's view from another place. Patterns and haze keep theirs.
    Camera from(const CameraDescription& camera) const;

    const Vec3& eye() const { return eye_; }
    const Vec3& right() const { return right_; }
    const Vec3& up() const { return up_; }
    const Vec3& forward() const { return forward_; }
    int width() const { return width_; }
    int height() const { return height_; }

    /// Distance from eye to target, m: the scale of what is looked at.
    double target_distance() const { return target_distance_; }

    /// What patterns fit, and where half of a thing's light is haze, m: the same for a whole clip. Until told otherwise the
    /// distance to the target and no haze.
    double viewing_distance() const { return viewing_distance_; }
    double fog_distance() const { return haze_distance_; }
    Camera with_distances(double viewing, double haze) const;

    /// The width of a pixel at distance 1 along the axis.
    double pixel_size() const { return 2.0 * tan_y_ / height_; }

    Vec3 relative(const Vec3& world) const { return world - eye_; }

    /// Where a point in front of the eye, relative to it, lands: pixels from the top left corner.
    Eigen::Vector2d pixel(const Vec3& relative) const;

    /// The ray through a point of the picture (pixels from the top left corner), one long along the axis.
    Vec3 ray(double x, double y) const;

    /// Inward unit normals of the four sides of the view, all through the eye.
    const std::array<Vec3, 4>& sides() const { return sides_; }

    /// Could a ball (relative to the eye) be in the picture?
    bool sees(const Vec3& center, double radius) const;

    /// Could a ball's shadow, thrown along a direction, be in the picture?
    bool sees_swept(const Vec3& center, double radius, const Vec3& direction) const;

    /// Relative position to clip space, for a near plane at this distance and none far away. The first row of the
    /// picture is at y = -1: glReadPixels then delivers it first, and nothing needs to be turned over.
    glm::mat4 clip_from_relative(double near_distance) const;

private:
    Vec3 eye_, right_, up_, forward_;
    double target_distance_, viewing_distance_;
    double haze_distance_ = std::numeric_limits<double>::infinity();
    int width_, height_;
    double tan_x_, tan_y_;
    Eigen::Vector2d shift_;  // pixels
    std::array<Vec3, 4> sides_;
};

}  // namespace tumble
