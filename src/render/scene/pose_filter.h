// The poses that are drawn. A body that trembles by less than an eye can see keeps the pose it was drawn with, so that
// what rests is not drawn anew: its drawn pose follows the true one when some point of it has moved by more than
//   |dp| + 2 r |dq| > drawn_tolerance pixels at its distance
// where dp is the way of its origin, r the radius around the origin that holds it all, dq the difference of the unit
// quaternions (of the two signs the smaller; a turn by a moves a point r away by at most 2 r sin(a / 2) <= 2 r |dq|).
//
// Where the camera moves, every pose is the true one (of a body that the camera follows, too, unless it only trembles:
// then the camera rests with it).
//
// Every frame of a clip goes through one PoseFilter, in order, before any is drawn: then all workers, and a full redraw,
// see the same drawn poses. Needs no OpenGL.
#pragma once

#include "render/camera/camera_animation.h"
#include "render/camera/camera.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <vector>

namespace tumble {

inline constexpr double drawn_tolerance = 0.02;   // pixels: far below what smooth edges show, far above rounding

class PoseFilter {
public:
    explicit PoseFilter(const SceneDescription& scene);

    /// Replaces the poses by those to draw (origin, orientation and center of mass; the rest is left as it is). False when
    /// they are those of the call before: the picture is the same to the last byte; never when the camera has moved. The
    /// first call says true.
    bool follow(Snapshot& snapshot);

private:
    struct Pose {
        Vec3 origin;
        Quat orientation;
        Vec3 center_of_mass;   // which a camera may follow
    };
    bool may_stay(std::size_t body, const Pose& drawn, const BodyState& state) const;

    /// The pose to draw of one body; false: that of before.
    bool settle(std::size_t body, BodyState& state);

    CameraAnimation path_;
    CameraDescription camera_;
    std::optional<std::size_t> followed_;
    Camera view_;
    std::vector<double> radii_;   // m, of each body around its origin; 0 where nothing of it is drawn; infinite: a plane
    std::vector<Pose> drawn_;     // empty before the first call
    bool first_ = true;           // no call yet; a scene may have no bodies
};

}  // namespace tumble
