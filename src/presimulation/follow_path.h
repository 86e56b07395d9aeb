// The paths of cameras that come up with a body in time (follow_time T): the critically damped answer y to the way x of
// the body,
//   y'' = w^2 (x - y) - 2 w y',  w = 2 / T,
// so that behind a body of constant speed the camera lags by the way of the time T. It begins at rest. The way is taken
// as straight between two frames, for which the answer is exact. Every frame of the clip is seen, from the first one
// on: a frame then looks the same wherever the drawing began.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace tumble {

class FollowPath {
public:
    /// The paths of the camera's shots and insets too.
    explicit FollowPath(const CameraDescription& camera);

    /// The next frame; one at the same time as the frame before is ignored.
    void see(const Snapshot& snapshot);

    bool seen() const { return !tracks_.empty() && !tracks_.front().times.empty(); }

    /// The camera with these paths, as keyframes in place of the bodies that it followed. It may have been placed
    /// meanwhile. Until a frame has been seen, it is unchanged.
    CameraDescription applied(const CameraDescription& camera) const;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        for (auto& track : self.tracks_) {
            archive.keep(track.times, track.ways);
            archive.require([&track] { return track.times.size() == track.ways.size(); });
        }
    }

private:
    /// The way of a camera from its place at the start.
    struct Track {
        std::size_t body;
        Vec3 start;  // m, pose of the body's origin at the start
        Quat start_rotation;
        double rate;   // w, 1/s
        double still;  // m: a camera that is nearer to its body's way than this, and as slow, stops there
        Vec3 target = Vec3::Zero(), way = Vec3::Zero(), velocity = Vec3::Zero();  // of the last frame; m, m/s
        std::vector<double> times = {};                                           // s
        std::vector<Vec3> ways = {};                                              // m
        void follow(double time, const Vec3& to);
    };
    std::vector<Track> tracks_;  // of cameras that lag, in the order of with_insets()
};

/// The paths of a run of its own, up to the scene's duration. `each` is called after each frame, and may throw to stop.
/// Where the simulation fails, the paths until then.
FollowPath simulated_path(const SceneDescription& scene, int threads, const std::function<void()>& each = nullptr);

}  // namespace tumble
