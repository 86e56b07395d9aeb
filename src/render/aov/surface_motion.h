// Image motion: the position in the next frame of the surface point that a pixel shows. The body moves rigidly, and the
// camera may move. Intermediate frames and occlusion in the next frame are ignored.
#pragma once

#include "render/aov/visibility_buffer.h"

#include <vector>

namespace tumble {

/// A point p of this frame (camera frame) is at turn p + shift in the next frame (its camera frame).
struct FrameMotion {
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();  // m
};

class SurfaceMotion {
public:
    SurfaceMotion(const ScenePlaces& now, const PinholeCamera& camera, const ScenePlaces& next,
                  const PinholeCamera& next_camera);

    /// True if neither the surface nor the camera has moved; the motion is then zero to the bit.
    bool rests(std::uint32_t surface) const { return rests_[surface] != 0; }
    bool background_rests() const { return camera_rests_; }

    /// Motion of a surface point under a pixel: columns and rows from this pixel's center to its position in the next
    /// frame. NaN if it is then behind the eye.
    Eigen::Vector2d of_surface(std::uint32_t surface, const Vec3& point, int column, int row) const;

    /// The same for the background, infinitely far away along a ray.
    Eigen::Vector2d of_nothing(const Vec3& ray, int column, int row) const;

private:
    Eigen::Vector2d to(const Vec3& next_point, int column, int row) const;

    std::vector<FrameMotion> surfaces_;  // parts, then cords, then the water, which stands still
    std::vector<char> rests_;            // of each surface
    std::vector<CordPlace> cords_now_, cords_next_;
    std::size_t parts_;
    bool camera_rests_;
    Mat3 camera_turn_;
    PinholeCamera next_camera_;
};

}  // namespace tumble
