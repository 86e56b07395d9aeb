// Pose of a moving camera, a function of the scene and one snapshot only, so that every render process gets the same
// pose. Three movements are composed:
// 1. along the keyframes;
// 2. around the target, by orbit * t about `up`;
// 3. with a followed body: eye and target are translated with its center of mass (the origin of a tumbling body swings
// about it).
// In a shot, another camera takes its place; a moving shot goes over from the view before.
// Straight above or below its target, where `up` leaves the roll undefined, the camera keeps the roll of the moment
// before.
#pragma once

#include "core/keyframe_curve.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

class CameraAnimation {
public:
    explicit CameraAnimation(const CameraDescription& camera);

    /// Eye, target, up, field of view and lens at the snapshot's time; the focus is a distance. A whole turn returns to
    /// the same bits.
    CameraDescription at(const Snapshot& snapshot) const;

    /// Displacement of the camera with the followed body; zero without one, m.
    Vec3 carried(const Snapshot& snapshot) const;

private:
    CameraDescription camera_;
    struct Tracks {
        KeyframeCurve eye, target, vertical_fov;
    };
    static std::optional<Tracks> tracks_of(const CameraDescription& camera);
    /// Up direction from the keyframes alone.
    Vec3 up_at(double time) const;
    /// Without shots.
    CameraDescription own_at(const Snapshot& snapshot) const;
    /// The shot at that time, and the number of shots if there is none.
    std::size_t shot_at(double time) const;

    std::optional<Tracks> tracks_;
    std::vector<CameraAnimation> shots_;  // of the camera's shots
};

/// The bodies that the camera, its shots and its insets follow, ascending.
std::vector<std::size_t> followed_bodies(const CameraDescription& camera);

/// True if both cameras show the same image.
bool same_place(const CameraDescription& a, const CameraDescription& b);

}  // namespace tumble
