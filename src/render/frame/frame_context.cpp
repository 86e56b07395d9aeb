#include "render/frame/frame_context.h"

#include "core/check.h"
#include "render/scene/drawable_bounds.h"
#include "render/scene/fog_distance.h"

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
      placed_(mirrored(description.camera, mirror)),
      camera_(first_camera(description, scene, shift, mirror)),
      cascades_(description, scene, camera_, shadow_map_texels) {}

bool FrameSetup::move_camera(const Snapshot& whole) {
    CameraDescription now = mirrored(animation_.at(whole), mirror_);
    if (same_place(now, placed_)) return false;
    placed_ = std::move(now);
    camera_ = camera_.from(placed_);
    return true;
}

std::vector<char> FrameSetup::find_moved(const Snapshot& snapshot, bool anew) {
    std::vector<char> moved(scene_->bodies.size(), 1);
    poses_.resize(moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const BodyState& state = snapshot.bodies[i];
        Pose& pose = poses_[i];
        if (!anew && pose.origin == state.origin && pose.orientation.coeffs() == state.orientation.coeffs())
            moved[i] = 0;
        pose = {state.origin, state.orientation};
    }
    return moved;
}

FrameContext FrameSetup::prepare(const Snapshot& whole, bool one_sample, bool full_redraw) {
    const Snapshot& snapshot = parts_.snapshot(whole);
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), scene_->bodies.size());
    FrameContext frame{*scene_, snapshot, camera_, one_sample};
    frame.anew = !std::exchange(finished_, false);
    frame.camera_moved = move_camera(whole);
    frame.moved = find_moved(snapshot, frame.anew);
    frame.unchanged = !full_redraw && !frame.anew && !frame.camera_moved &&
                      std::find(frame.moved.begin(), frame.moved.end(), char(1)) == frame.moved.end();
    if (frame.unchanged) return frame;
    frame.drawables = make_drawables(*scene_, snapshot, camera_);
    frame.near_distance = near_distance_for(*scene_, snapshot, camera_);
    frame.cascades = cascades_.fit(*scene_, snapshot, camera_, animation_.carried(whole));
    frame.planes = make_plane_patches(*scene_, snapshot, camera_, frame.near_distance);
    return frame;
}

}  // namespace tumble
