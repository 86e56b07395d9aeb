#include "presimulation/motion_camera.h"

#include "core/error.h"
#include "presimulation/follow_path.h"
#include "scene/camera/default_camera.h"
#include "sim/geometry/shapes/shape.h"
#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr std::size_t most_poses = 60'000;  // of all bodies: 5 MB, and 10 ms to frame
constexpr double least_way = 0.25;          // of a body's size: one that comes less far stands still,
constexpr double least_cosine = 0.99;       // unless it turns: of half the angle, 16 degrees
constexpr double far_alone = 20.0;          // of a body's size: 50 pixels of 1280 are left of it
constexpr double far_from_others = 2.0;     // of the extent of all moving bodies at the start
constexpr double rim = 0.25;                // of the motion's extent, in which bodies that leave it are still framed
constexpr std::size_t crowd = 50;           // bodies; a larger number of them is a crowd
constexpr double of_crowd = 0.98;           // this part of a crowd is always framed, the nearest to its middle
constexpr double far_from_crowd = 1.3;      // a body of the rest is left out if it comes this many times farther
constexpr std::size_t visible_places = 24;  // that must not be hidden; more tell no more

}  // namespace

MotionCamera::MotionCamera(const SceneDescription& scene) : scene_(&scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        if (body.type == BodyType::fixed || endless(body.shape) || !body.appearance.visible) continue;
        const Bounds bounds = local_bounds(body.shape);
        bodies_.push_back({i, bounds.center(), 0.5 * bounds.extent(), {}});
    }
}

bool MotionCamera::Body::moves() const {
    const Pose& start = poses.front();
    return std::ranges::any_of(poses, [&](const Pose& pose) {
        return (pose.middle - start.middle).norm() > least_way * size() ||
               std::fabs(pose.rotation.dot(start.rotation)) < least_cosine;
    });
}

void MotionCamera::see(const Snapshot& snapshot) {
    const double half_frame = 0.5 / scene_->output.fps;  // s
    if (bodies_.empty() || snapshot.time > scene_->camera.fitted_time + half_frame) return;
    if (seen_++ % every_ != 0) return;
    if ((bodies_.front().poses.size() + 1) * bodies_.size() > most_poses && bodies_.front().poses.size() > 8)
        thin_out();
    for (Body& body : bodies_) {
        const BodyState& state = snapshot.bodies[body.index];
        body.poses.push_back({state.origin + state.orientation * body.center, state.orientation});
    }
}

/// Keeps every other pose, and from now on takes half as many.
void MotionCamera::thin_out() {
    every_ *= 2;
    for (Body& body : bodies_) {
        for (std::size_t i = 0; 2 * i < body.poses.size(); ++i) body.poses[i] = body.poses[2 * i];
        body.poses.resize((body.poses.size() + 1) / 2);
    }
}

void MotionCamera::add(const MotionCamera& other) {
    if (other.bodies_.size() != bodies_.size()) return;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        bodies_[i].poses.insert(bodies_[i].poses.end(), other.bodies_[i].poses.begin(), other.bodies_[i].poses.end());
}

std::vector<const MotionCamera::Body*> MotionCamera::movers() const {
    std::vector<const Body*> moving;
    for (const Body& body : bodies_)
        if (body.moves()) moving.push_back(&body);
    if (moving.empty())
        for (const Body& body : bodies_) moving.push_back(&body);
    if (moving.size() <= crowd) return moving;

    Vec3 middle;
    for (Eigen::Index c = 0; c < 3; ++c) {
        std::vector<double> places;
        for (const Body* body : moving) places.push_back(body->poses.back().middle[c]);
        std::nth_element(places.begin(), places.begin() + std::ptrdiff_t(places.size() / 2), places.end());
        middle[c] = places[places.size() / 2];
    }
    const auto reach = [&](const Body* body) {
        double most = 0.0;
        for (const Pose& pose : body->poses) most = std::max(most, (pose.middle - middle).norm());
        return most;
    };
    std::vector<std::pair<double, const Body*>> by_reach;
    for (const Body* body : moving) by_reach.emplace_back(reach(body), body);
    std::ranges::stable_sort(by_reach, {}, &std::pair<double, const Body*>::first);
    const double usual = by_reach[std::size_t(of_crowd * double(moving.size()))].first;
    std::erase_if(by_reach, [&](const auto& one) { return one.first > far_from_crowd * usual; });
    moving.clear();
    for (const auto& [far, body] : by_reach) moving.push_back(body);
    return moving;
}

CameraDescription MotionCamera::camera() const {
    if (bodies_.empty() || bodies_.front().poses.empty()) return scene_->camera;
    const std::vector<const Body*> moving = movers();

    Bounds start;
    for (const Body* body : moving) {
        start.add(body->poses.front().middle + Vec3::Constant(0.5 * body->size()));
        start.add(body->poses.front().middle - Vec3::Constant(0.5 * body->size()));
    }
    const double extent = start.extent().norm();
    const auto outside = [](const Bounds& bounds, const Vec3& p) {
        return (p - p.cwiseMax(bounds.min).cwiseMin(bounds.max)).norm();
    };
    const auto farthest = [&](const Body& body) { return std::max(far_alone * body.size(), far_from_others * extent); };
    const auto leaves = [&](const Body& body) {
        return std::ranges::any_of(body.poses,
                                   [&](const Pose& pose) { return outside(start, pose.middle) > farthest(body); });
    };
    // The region of the bodies that stay; without one, each flies as far as it can be seen.
    Bounds stays;
    for (const Body* body : moving)
        if (!leaves(*body))
            for (const Pose& pose : body->poses) stays.add(pose.middle);
    const bool all_leave = stays.empty();
    stays.add(start);
    const Bounds framed = stays.grown(rim * stays.extent().norm());

    ShownMotion motion;
    const auto add_corners = [&](const Body& body, const Pose& pose) {
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 side(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
            motion.points.push_back(pose.middle + pose.rotation * side.cwiseProduct(body.half_size));
        }
    };
    std::vector<Vec3> middles;
    for (const Body* body : moving) {
        const Pose* before = nullptr;
        const bool gone = leaves(*body);
        for (const Pose& pose : body->poses) {
            if (gone &&
                (all_leave ? outside(start, pose.middle) > farthest(*body) : outside(framed, pose.middle) > 0.0))
                break;
            add_corners(*body, pose);
            middles.push_back(pose.middle);
            if (before != nullptr) {
                const Vec3 way = pose.middle - before->middle;
                motion.paths += way * way.transpose();
            }
            before = &pose;
        }
    }
    const std::size_t places = std::min(middles.size(), visible_places);
    for (std::size_t i = 0; i < places; ++i) motion.places.push_back(middles[(i + 1) * middles.size() / places - 1]);
    motion.stands.assign(scene_->bodies.size(), 0);
    for (const Body& body : bodies_) motion.stands[body.index] = 1;
    for (const Body* body : moving) motion.stands[body->index] = 0;
    CameraDescription placed = scene_->camera;
    const auto place = [&](CameraDescription& camera) {
        if (camera.fits_motion()) camera = with_own_place(camera_of_motion(*scene_, camera, motion), camera);
    };
    place(placed);
    for (CameraShot& shot : placed.shots) place(shot.camera);
    for (CameraInset& inset : placed.insets) place(inset.camera);
    return placed;
}

MotionCamera simulated_motion(const SceneDescription& scene, int threads, const std::function<void()>& each) {
    MotionCamera camera(scene);
    World world(scene, threads);
    const std::int64_t frames = scene.timing().frame_count(scene.camera.fitted_time);
    for (std::int64_t n = 0; n < frames; ++n) {
        try {
            if (n > 0) world.advance_frame();
        } catch (const RunError&) {
            break;
        }
        camera.see(world.snapshot());
        if (each) each();
    }
    return camera;
}

SceneDescription framed(const SceneDescription& scene, int threads, const std::function<void()>& each) {
    SceneDescription placed = scene;
    if (scene.camera.any_fits_motion()) placed.camera = simulated_motion(scene, threads, each).camera();
    if (scene.camera.any_lags()) placed.camera = simulated_path(scene, threads, each).applied(placed.camera);
    return placed;
}

}  // namespace tumble
