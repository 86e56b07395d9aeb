// Where a moving camera is: a function of the scene and one snapshot alone, so that every process that draws finds the
// same place. Three movements, one after the other: along the keyframes; in a circle about the target, by
// orbit * t around `up`; along with a body, eye and target by the way that its center of mass has gone (a body that tumbles
// turns around that, and its origin swings). Straight above or below its target, where `up` does not tell how the picture is
// turned, it is turned as just before.
#pragma once

#include "core/keyframe_curve.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <optional>

namespace tumble {

class CameraAnimation {
public:
    explicit CameraAnimation(const CameraDescription& camera);

    /// Eye, target, up and field of view at the snapshot's time. A whole turn comes back to the last bit.
    CameraDescription at(const Snapshot& snapshot) const;

    /// How far the followed body has carried the camera; zero without one, m.
    Vec3 carried(const Snapshot& snapshot) const;

private:
    CameraDescription camera_;
    struct Tracks {
        KeyframeCurve eye, target, vertical_fov;
    };
    static std::optional<Tracks> tracks_of(const CameraDescription& camera);
    /// The way that is up in the picture, by the keyframes alone.
    Vec3 up_at(double time) const;

    std::optional<Tracks> tracks_;
};

/// Do both show the same picture?
bool same_place(const CameraDescription& a, const CameraDescription& b);

}  // namespace tumble
