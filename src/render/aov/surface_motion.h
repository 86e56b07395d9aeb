// Where the point of a surface that a pixel shows is seen in the next frame: its body moves as a rigid one, and the camera
// may move as well. The frames in between, and what may hide the point then, do not matter.
#pragma once

#include "render/aov/surface_map.h"

#include <optional>
#include <vector>

namespace tumble {

/// A point p of this frame (camera's frame) is at turn p + shift in the next one (the next camera's frame).
struct RigidMotion {
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();   // m
};

class SurfaceMotion {
public:
    SurfaceMotion(const ScenePlaces& now, const PinholeCamera& camera, const ScenePlaces& next,
                  const PinholeCamera& next_camera);

    /// Of a surface's point under a pixel: columns and rows from this pixel's centre to its place in the next frame; zero to
    /// the bit where neither it nor the camera has moved. NaN where it is then behind the eye.
    Eigen::Vector2d of_surface(std::uint32_t surface, const Vec3& point, int column, int row) const;

    /// The same of the background, infinitely far away along a ray.
    Eigen::Vector2d of_nothing(const Vec3& ray, int column, int row) const;

private:
    Eigen::Vector2d to(const Vec3& next_point, int column, int row) const;

    std::vector<std::optional<RigidMotion>> surfaces_;   // parts, then cords; nothing: it rests in the picture
    std::vector<CordPlace> cords_now_, cords_next_;
    std::size_t parts_;
    std::optional<Mat3> camera_turn_;                    // nothing: the camera rests
    PinholeCamera next_camera_;
};

}  // namespace tumble
