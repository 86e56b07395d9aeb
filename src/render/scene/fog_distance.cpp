#include "render/scene/fog_distance.h"

#include "render/camera/camera.h"
#include "render/scene/distance_outliers.h"
#include "render/shapes/drawing_style.h"

#include <algorithm>
#include <vector>

namespace tumble {
namespace {

// Distance from a point to the bounding box of a body, m; 0 inside.
double gap_to(const Vec3& eye, const RenderBody& proxy, const Vec3& origin, const Quat& rotation) {
    const Vec3 from = rotation.conjugate() * (eye - origin) - proxy.bound_center;
    return (from.cwiseAbs() - proxy.half_extent).cwiseMax(0.0).norm();
}

}  // namespace

double viewing_distance(const SceneDescription& description, const RenderScene& scene) {
    double to_target = 0.0, to_bodies = 0.0;
    std::vector<double> distances;
    const auto add = [&](const Vec3& eye, const Vec3& target) {
        to_target = std::max(to_target, (target - eye).norm());
        distances.clear();
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const RenderBody& proxy = scene.bodies[i];
            if (!proxy.solid() || proxy.buried) continue;
            const BodyDescription& body = description.bodies[i];
            distances.push_back((body.position + body.rotation * proxy.bound_center - eye).norm());
        }
        if (distances.empty()) return;
        to_bodies = std::max(to_bodies, lower_median(distances));
    };
    for (const CameraDescription* camera : description.camera.all()) {
        if (camera->keyframes.empty()) add(camera->eye, camera->target);
        for (const CameraKeyframe& key : camera->keyframes) add(key.eye, key.target);
    }
    if (to_bodies > 0.0)
        to_target = std::clamp(to_target, to_bodies / style::about_there, to_bodies * style::about_there);
    return to_target > 0.0 ? to_target : 1.0;
}

double fog_distance(const SceneDescription& description, const RenderScene& scene, double viewing_distance) {
    double distance = style::half_fog * viewing_distance;
    CameraDescription camera;
    const auto seen_from_camera = [&] {
        const Camera view(camera, description.output.width, description.output.height);
        const double least_slope =
            style::large_part * view.pixel_size() * view.height();  // of a body's width to its distance
        const auto add = [&](const RenderBody& proxy, const Vec3& origin, const Quat& rotation) {
            const Vec3 center = view.relative(origin + rotation * proxy.bound_center);
            const bool large = 2.0 * proxy.bound_radius >= least_slope * center.norm();
            if (large && (description.camera.moves() || view.sees(center, proxy.bound_radius)))
                distance = std::max(distance, style::beyond_large * gap_to(camera.eye, proxy, origin, rotation));
        };
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const RenderBody& proxy = scene.bodies[i];
            if (!proxy.solid() || proxy.buried) continue;
            add(proxy, description.bodies[i].position, description.bodies[i].rotation);
            for (const Keyframe& key : description.bodies[i].keyframes) add(proxy, key.position, key.rotation);
        }
    };
    for (const CameraDescription* one : description.camera.all()) {
        camera = *one;
        camera.keyframes.clear();
        camera.shots.clear();
        if (one->keyframes.empty()) seen_from_camera();
        for (const CameraKeyframe& key : one->keyframes) {
            camera.eye = key.eye;
            camera.target = key.target;
            camera.vertical_fov = key.vertical_fov;
            seen_from_camera();
        }
    }
    return distance;
}

}  // namespace tumble
