// Default camera of scenes without one: from the front, slightly from the right and above, as near as the bodies allow.
#pragma once

#include "scene/description/description.h"

#include <cstddef>
#include <vector>

namespace tumble {

/// Keeps `lens.up` and `lens.vertical_fov`. Chooses eye and target so that these are in the image:
/// - all bodies but planes, with moving ones at the start, at their keyframes and where they would drop to;
/// - thrown bodies on their trajectories in the first `seconds` (throw_preview.h);
/// - of a ground made of a body (fixed, and many times larger than all moving bodies) only the part near the moving
/// bodies.
/// Where fixed bodies would hide bodies in them, the camera is raised.
CameraDescription default_camera(const SceneDescription& scene, const CameraDescription& lens, double seconds = 0.0);

/// A motion to be shown, in the world frame.
struct ShownMotion {
    std::vector<Vec3> points;   // m: in the image
    std::vector<Vec3> places;   // m: not to be hidden by fixed bodies
    Mat3 paths = Mat3::Zero();  // m^2: sum of d d^T over all displacements d
    std::vector<char> stands;   // by body: it is framed where it is near the motion, as fixed bodies are
};

/// The same for a motion that is known. The side is the one from which its direction is seen; a motion that spreads
/// over the ground is seen from higher up.
CameraDescription camera_of_motion(const SceneDescription& scene, const CameraDescription& lens,
                                   const ShownMotion& motion);

/// rad: within this angle of `up` the roll is undefined.
inline constexpr double least_roll_angle = 1e-6;

/// The camera with the eye and the target that are its own, and otherwise the chosen ones: an eye or a target alone
/// keeps the chosen offset.
CameraDescription with_own_place(CameraDescription chosen, const CameraDescription& own);

/// Points around the trajectories of bodies with an initial velocity in the first `seconds`. Each body is simulated
/// alone, as a ball that flies, bounces off planes and fixed bodies, slides with friction (balls roll), and stops at
/// another moving body. A trajectory ends where the body would be small on the screen. Empty if very many bodies are
/// thrown.
std::vector<Vec3> flight_points(const SceneDescription& scene, double seconds);

}  // namespace tumble
