#include "render/viewing_distance.h"

#include "render/far_limit.h"

#include <algorithm>
#include <vector>

namespace tumble {
namespace {

// The target counts where it is up to so many times as near or as far as the middle one of the bodies.
constexpr double about_there = 2.0;

}  // namespace

double viewing_distance(const SceneDescription& scene, const SceneLooks& looks) {
    double to_target = 0.0, to_bodies = 0.0;
    std::vector<double> distances;
    const auto add = [&](const Vec3& eye, const Vec3& target) {
        to_target = std::max(to_target, (target - eye).norm());
        distances.clear();
        for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
            const BodyLook& look = looks.bodies[i];
            if (look.kind == DrawKind::hidden || look.kind == DrawKind::plane) continue;
            const BodyDescription& body = scene.bodies[i];
            distances.push_back((body.position + body.rotation * look.bound_center - eye).norm());
        }
        if (distances.empty()) return;
        to_bodies = std::max(to_bodies, lower_median(distances));
    };
    if (scene.camera.keyframes.empty()) add(scene.camera.eye, scene.camera.target);
    for (const CameraKeyframe& key : scene.camera.keyframes) add(key.eye, key.target);
    if (to_bodies > 0.0) to_target = std::clamp(to_target, to_bodies / about_there, to_bodies * about_there);
    return to_target > 0.0 ? to_target : 1.0;
}

}  // namespace tumble
