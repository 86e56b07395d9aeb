// Filters the poses to draw, so that resting bodies with invisible jitter are not redrawn. The drawn pose follows the
// true one when some point of the body has moved by more than
//   |dp| + 2 r |dq| > drawn_tolerance pixels at its distance
// where dp is the displacement of its origin, r the radius around the origin that contains the body, and dq the
// difference of the unit quaternions (the smaller of both signs; a rotation by a moves a point at r by at most 2 r
// sin(a / 2) <= 2 r |dq|).
//
// While the camera moves, every drawn pose is the true one. So is that of a body that a camera follows, unless the
// body only jitters: then both stand still.
//
// Every frame of a clip passes through one PoseFilter, in order, before any is drawn, so that all workers and a full
// redraw see the same poses. Needs no OpenGL.
#pragma once

#include "render/camera/camera.h"
#include "render/camera/camera_animation.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <type_traits>
#include <vector>

namespace tumble {

inline constexpr double drawn_tolerance = 0.02;  // pixels: far below what smooth edges show, far above rounding

class PoseFilter {
public:
    explicit PoseFilter(const SceneDescription& scene);

    /// Replaces the poses by those to draw (origin, orientation and center of mass; the rest is unchanged). Returns
    /// false if they equal those of the previous call, so that the frame is the same to the last byte; returns true on
    /// the first call, when the camera has moved, and in scenes with waves.
    bool follow(Snapshot& snapshot);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [views, followed, waves, radii, drawn, first] = self;
        archive.rebuilt(followed, waves, radii);
        for (auto& [path, camera, view] : views) {
            archive.keep(camera.eye, camera.target, camera.up, camera.vertical_fov);
            if constexpr (!std::is_const_v<Self>) view = view.from(camera);
        }
        archive.keep(drawn, first);
    }

private:
    struct Pose {
        Vec3 origin;
        Quat orientation;
        Vec3 center_of_mass;  // which a camera may follow
        bool absent = false;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [origin, orientation, center_of_mass, absent] = self;
            archive.keep(origin, orientation, center_of_mass, absent);
        }
    };
    bool follows(std::size_t body) const;
    bool may_stay(std::size_t body, const Pose& drawn, const BodyState& state) const;

    /// Updates the pose to draw of one body; false: it is unchanged.
    bool settle(std::size_t body, BodyState& state);

    /// Moves each view to the snapshot's time; true if one has moved.
    bool move_views(const Snapshot& snapshot);

    struct View {
        CameraAnimation path;
        CameraDescription camera;
        Camera view;
    };
    std::vector<View> views_;  // of the picture, and of its insets
    std::vector<std::size_t> followed_;
    bool waves_;                 // the picture changes with the time
    std::vector<double> radii_;  // m, of each body around its origin; 0: not drawn; infinite: a plane
    std::vector<Pose> drawn_;    // empty before the first call
    bool first_ = true;          // no call yet; a scene may have no bodies
};

}  // namespace tumble
