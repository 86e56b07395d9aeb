// The inputs of one frame, computed once from a snapshot and then read by all stages: culling, ambient occlusion,
// damage, passes and antialiasing.
#pragma once

#include "render/camera/camera.h"
#include "render/camera/camera_animation.h"
#include "render/scene/compound_expansion.h"
#include "render/scene/drawable_bounds.h"
#include "render/scene/plane_patch.h"
#include "render/scene/render_scene.h"
#include "render/shadow/lamp_map.h"
#include "render/shadow/shadow_cascades.h"
#include "sim/snapshot/snapshot.h"

#include <optional>
#include <vector>

namespace tumble {

struct FrameContext {
    const RenderScene& scene;
    const Snapshot& snapshot;  // one state per body of the render scene: compounds are expanded
    const Camera& camera;
    bool one_sample = false;    // per pixel, at its center
    bool anew = false;          // the previous frame is unknown: every body counts as moved
    bool camera_moved = false;  // since the previous frame
    bool unchanged = false;     // nothing moved: the frame equals the previous one, and the fields below are unset
    std::vector<char> moved{};  // by body: its pose differs from that of the previous frame
    PerDrawable<DrawableBounds> drawables{};
    double near_distance = 0.0;  // m
    ShadowCascades cascades{};
    std::optional<LampMap> lamp_map{};  // of the second light with shadows, if there is one
    std::vector<PlanePatch> planes{};   // visible from their open side
};

/// Prepares the frames of a clip: it owns the camera and the poses of the previous frame.
class FrameSetup {
public:
    /// `description`: without compounds (see expand_compounds()); `scene`: made from it, must outlive this object.
    /// `shift`: displacement of the frame, pixels. `mirror`: see RenderSwitches.
    FrameSetup(const SceneDescription& description, const RenderScene& scene, PartPoses parts = {},
               const Eigen::Vector2d& shift = Eigen::Vector2d::Zero(), const std::optional<PlaneShape>& mirror = {});
    FrameSetup(const FrameSetup&) = delete;
    FrameSetup& operator=(const FrameSetup&) = delete;

    /// `whole`: of the bodies of the scene file. `full_redraw`: the frame never counts as unchanged. The result is
    /// valid until the next call, or as long as the argument.
    FrameContext prepare(const Snapshot& whole, bool one_sample, bool full_redraw = false);

    /// The frames that follow are seen through this point of the lens, in radii from its middle.
    void look_through(const Eigen::Vector2d& point) { lens_point_ = point; }

    /// The points of the lens at that time; 0: a pinhole.
    int lens_samples(const Snapshot& whole) const;

    /// True if the frame before is drawn, and shows this one.
    bool shows(const Snapshot& whole);

    /// Call when the prepared frame is drawn. Without it, after an exception, the next frame is made anew.
    void finish() { finished_ = true; }

    const Camera& camera() const { return camera_; }
    const ShadowFilter& shadow_filter() const { return cascades_.filter(); }

private:
    struct Pose {
        Vec3 origin;
        Quat orientation;
        bool absent = false;
        bool operator==(const Pose& other) const {
            return absent == other.absent &&
                   (absent || (origin == other.origin && orientation.coeffs() == other.orientation.coeffs()));
        }
    };
    bool move_camera(const Snapshot& whole);
    bool same_bodies(const Snapshot& snapshot) const;
    std::vector<char> find_moved(const Snapshot& snapshot, bool anew);

    const RenderScene* scene_;
    PartPoses parts_;
    CameraAnimation animation_;
    std::optional<PlaneShape> mirror_;
    bool has_lens_;
    CameraDescription placed_;  // the camera of the previous frame
    Camera pinhole_, camera_;
    Eigen::Vector2d lens_point_ = Eigen::Vector2d::Zero(), seen_through_ = Eigen::Vector2d::Zero();
    CascadeFitter cascades_;
    std::optional<LampMapFitter> lamp_map_;
    std::vector<Pose> poses_;   // of the previous frame
    double waves_time_ = -1.0;  // s, of the previous frame
    bool finished_ = false;     // the previous frame is drawn
};

}  // namespace tumble
