#include "render/frame/frame_context.h"

#include "core/check.h"
#include "render/camera/lens.h"
#include "render/scene/drawable_bounds.h"
#include "render/scene/fog_distance.h"
#include "scene/description/lamps.h"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

CameraDescription mirrored(CameraDescription camera, const std::optional<PlaneShape>& mirror) {
    if (!mirror) return camera;
    const Vec3& n = mirror->normal;
    camera.eye -= 2.0 * (n.dot(camera.eye) - mirror->offset) * n;
    camera.target -= 2.0 * (n.dot(camera.target) - mirror->offset) * n;
    camera.up -= 2.0 * n.dot(camera.up) * n;
    return camera;
}

Camera first_camera(const SceneDescription& description, const RenderScene& scene, const Eigen::Vector2d& shift,
                    const std::optional<PlaneShape>& mirror) {
    const double viewing = viewing_distance(description, scene);
    return Camera(mirrored(description.camera, mirror), description.output.width, description.output.height, shift)
        .with_distances(viewing, fog_distance(description, scene, viewing));
}

}  // namespace

FrameSetup::FrameSetup(const SceneDescription& description, const RenderScene& scene, PartPoses parts,
                       const Eigen::Vector2d& shift, const std::optional<PlaneShape>& mirror)
    : scene_(&scene),
      parts_(std::move(parts)),
      animation_(description.camera),
      mirror_(mirror),
      has_lens_(has_lens(description.camera)),
      placed_(mirrored(description.camera, mirror)),
      pinhole_(first_camera(description, scene, shift, mirror)),
      camera_(pinhole_),
      cascades_(description, scene, camera_, shadow_map_texels) {
    if (second_shadow(scene.lamps)) lamp_map_.emplace(description, scene, camera_);
}

bool FrameSetup::move_camera(const Snapshot& whole) {
    CameraDescription now = mirrored(animation_.at(whole), mirror_);
    if (same_place(now, placed_) && now.dof == placed_.dof && lens_point_ == seen_through_) return false;
    placed_ = std::move(now);
    seen_through_ = lens_point_;
    camera_ = pinhole_ = pinhole_.from(placed_);
    if (placed_.dof && seen_through_ != Eigen::Vector2d::Zero()) {
        const double radius = 0.5 * placed_.dof->aperture;
        const Eigen::Vector2d point(mirror_ ? -seen_through_.x() : seen_through_.x(), seen_through_.y());
        camera_ = pinhole_.through(radius * point, placed_.dof->focus);
    }
    return true;
}

int FrameSetup::lens_samples(const Snapshot& whole) const {
    if (!has_lens_) return 0;
    const CameraDescription now = animation_.at(whole);
    return now.dof && now.dof->aperture > 0.0 ? now.dof->samples : 0;
}

bool FrameSetup::shows(const Snapshot& whole) {
    const CameraDescription now = mirrored(animation_.at(whole), mirror_);
    if (!finished_ || !same_place(now, placed_) || now.dof != placed_.dof) return false;
    if (!scene_->surface.still() && waves_time_ != whole.time) return false;
    return std::ranges::equal(poses_, parts_.snapshot(whole).bodies, [](const Pose& pose, const BodyState& state) {
        return pose == Pose{state.origin, state.orientation, state.absent};
    });
}

// A frame in which a body appears or vanishes has nothing in common with the one before.
bool FrameSetup::same_bodies(const Snapshot& snapshot) const {
    return std::ranges::equal(poses_, snapshot.bodies, {}, &Pose::absent, &BodyState::absent);
}

std::vector<char> FrameSetup::find_moved(const Snapshot& snapshot, bool anew) {
    std::vector<char> moved(scene_->bodies.size(), 1);
    poses_.resize(moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const BodyState& state = snapshot.bodies[i];
        const Pose now{state.origin, state.orientation, state.absent};
        if (!anew && poses_[i] == now) moved[i] = 0;
        poses_[i] = now;
    }
    return moved;
}

FrameContext FrameSetup::prepare(const Snapshot& whole, bool one_sample, bool full_redraw) {
    const Snapshot& snapshot = parts_.snapshot(whole);
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), scene_->bodies.size());
    FrameContext frame{*scene_, snapshot, camera_, one_sample};
    frame.anew = !std::exchange(finished_, false) || !same_bodies(snapshot);
    frame.camera_moved = move_camera(whole);
    frame.moved = find_moved(snapshot, frame.anew);
    const bool waves = !scene_->surface.still() && std::exchange(waves_time_, snapshot.time) != snapshot.time;
    frame.unchanged = !full_redraw && !frame.anew && !frame.camera_moved && !waves &&
                      std::find(frame.moved.begin(), frame.moved.end(), char(1)) == frame.moved.end();
    if (frame.unchanged) return frame;
    if (scene_->water) frame.camera_moved = true;  // the surface is drawn over the whole frame
    frame.drawables = make_drawables(*scene_, snapshot, camera_);
    frame.near_distance = near_distance_for(*scene_, snapshot, camera_);
    frame.cascades = cascades_.fit(*scene_, snapshot, camera_, animation_.carried(whole));
    if (lamp_map_) frame.lamp_map = lamp_map_->fit(*scene_, snapshot, camera_, animation_.carried(whole));
    frame.planes = make_plane_patches(*scene_, snapshot, camera_, frame.near_distance);
    return frame;
}

}  // namespace tumble
