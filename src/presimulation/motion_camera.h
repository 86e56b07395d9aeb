// The default camera by the motion that happens: bodies are framed where they move, for as long as they move.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace tumble {

/// Sees the frames of a run and places the camera. Left out are
/// - bodies that fly away, once they are outside of the motion of the others (or, if all do, far off for their size);
/// - of very many bodies those few that come far away from the rest;
/// - bodies that stand still, unless they are near the moving ones or none moves.
class MotionCamera {
public:
    /// `scene` must outlive it.
    explicit MotionCamera(const SceneDescription& scene);

    /// The next frame. Frames behind the duration in the scene's file are not framed, so that a frame looks the same in
    /// a clip of any length.
    void see(const Snapshot& snapshot);
    /// Frames the motion of another run of the same bodies too, so that both are shown alike. Ignores other bodies.
    void add(const MotionCamera& other);

    /// False if it has seen no frame, or there is nothing to see.
    bool seen() const { return seen_ > 0; }
    /// The scene's camera with its shots. Every camera that has no eye or no target of its own is placed so that the
    /// motion fills the frame; a given eye or target is kept.
    CameraDescription camera() const;

private:
    struct Pose {
        Vec3 middle;  // m, of the bounding box
        Quat rotation;
    };
    struct Body {
        std::size_t index;
        Vec3 center;     // m, of the bounding box, in the body's frame
        Vec3 half_size;  // m
        std::vector<Pose> poses;
        bool moves() const;
        double size() const { return 2.0 * half_size.norm(); }
    };
    void thin_out();
    std::vector<const Body*> movers() const;

    const SceneDescription* scene_;
    std::vector<Body> bodies_;           // that are not fixed
    std::int64_t every_ = 1, seen_ = 0;  // of the frames one in so many is kept
};

/// The motion of a run of its own. `each` is called after each frame, and may throw to stop. Where the simulation
/// fails, the motion until then.
MotionCamera simulated_motion(const SceneDescription& scene, int threads, const std::function<void()>& each = nullptr);

/// The scene with its camera by a run of its own, where its motion decides the place or the path of the camera.
SceneDescription framed(const SceneDescription& scene, int threads, const std::function<void()>& each = nullptr);

}  // namespace tumble
