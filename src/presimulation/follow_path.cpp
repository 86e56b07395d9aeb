#include "presimulation/follow_path.h"

#include "core/deterministic_math.h"
#include "core/error.h"
#include "core/keyframe_curve.h"
#include "sim/world.h"

#include <optional>
#include <utility>

namespace tumble {
namespace {

constexpr double still_view = 1e-5;  // of the distance from eye to target: a hundredth of a pixel

/// The path of a camera by its own keyframes.
class OwnPath {
public:
    explicit OwnPath(const CameraDescription& camera) : camera_(camera) {
        if (camera.keyframes.empty()) return;
        eye_ = curve([](const CameraKeyframe& key) -> Eigen::VectorXd { return key.eye; });
        target_ = curve([](const CameraKeyframe& key) -> Eigen::VectorXd { return key.target; });
        fov_ = curve([](const CameraKeyframe& key) { return Eigen::VectorXd::Constant(1, key.vertical_fov).eval(); });
    }

    CameraKeyframe at(double time) const {
        if (!eye_) return {time, camera_.eye, camera_.target, camera_.vertical_fov};
        return {time, eye_->at(time), target_->at(time), fov_->at(time)[0]};
    }

private:
    template <class Value>
    KeyframeCurve curve(const Value& value_of) const {
        std::vector<double> times;
        std::vector<Eigen::VectorXd> values;
        for (const CameraKeyframe& key : camera_.keyframes) {
            times.push_back(key.time);
            values.push_back(value_of(key));
        }
        return {std::move(times), std::move(values), camera_.interpolation == Interpolation::smooth};
    }

    CameraDescription camera_;
    std::optional<KeyframeCurve> eye_, target_, fov_;
};

}  // namespace

FollowPath::FollowPath(const CameraDescription& camera) {
    for (const CameraDescription* one : camera.with_insets())
        if (one->lags())
            tracks_.push_back({*one->follow, one->follow_start, one->follow_start_rotation, 2.0 / *one->follow_time,
                               still_view * (one->target - one->eye).norm()});
}

void FollowPath::Track::follow(double time, const Vec3& to) {
    if (!times.empty() && time <= times.back()) return;
    if (!times.empty()) {
        // d = y - x + lag is (a + b t) exp(-w t), with the lag 2 u / w behind a way of the speed u.
        const double span = time - times.back(), decay = exponential(-rate * span);
        const Vec3 speed = (to - target) / span, lag = 2.0 / rate * speed;
        const Vec3 a = way - target + lag, b = velocity - speed + rate * a;
        way = to - lag + decay * (a + span * b);
        velocity = speed + decay * (b - rate * (a + span * b));
        if (speed == Vec3::Zero() && (way - to).norm() < still && velocity.norm() < still * rate) {
            way = to;
            velocity = Vec3::Zero();
        }
    }
    target = to;
    times.push_back(time);
    ways.push_back(way);
}

void FollowPath::see(const Snapshot& snapshot) {
    for (Track& track : tracks_) {
        const BodyState& body = snapshot.bodies.at(track.body);
        const Vec3 center = body.orientation.conjugate() * (body.center_of_mass - body.origin);
        track.follow(snapshot.time, body.center_of_mass - (track.start + track.start_rotation * center));
    }
}

CameraDescription FollowPath::applied(const CameraDescription& camera) const {
    CameraDescription placed = camera;
    auto track = tracks_.begin();
    const auto apply = [&](CameraDescription& one) {
        if (!one.lags()) return;
        const Track& path = *track++;
        if (path.times.empty()) return;
        const OwnPath own(one);
        const auto add = [&](double time, const Vec3& way) {
            CameraKeyframe& key = one.keyframes.emplace_back(own.at(time));
            key.eye += way;
            key.target += way;
        };
        one.follow.reset();
        one.interpolation = Interpolation::linear;
        one.keyframes.clear();
        for (std::size_t i = 0; i < path.times.size(); ++i) add(path.times[i], path.ways[i]);
        // The shutter of the last frame is open after the last state: the camera goes on.
        const std::size_t count = path.times.size();
        if (count < 2 || path.ways[count - 1] == path.ways[count - 2]) return;
        add(2.0 * path.times[count - 1] - path.times[count - 2], 2.0 * path.ways[count - 1] - path.ways[count - 2]);
    };
    apply(placed);
    for (CameraShot& shot : placed.shots) apply(shot.camera);
    for (CameraInset& inset : placed.insets) apply(inset.camera);
    return placed;
}

FollowPath simulated_path(const SceneDescription& scene, int threads, const std::function<void()>& each) {
    FollowPath path(scene.camera);
    World world(scene, threads);
    for (std::int64_t n = 0; n < scene.frame_count(); ++n) {
        try {
            if (n > 0) world.advance_frame();
        } catch (const RunError&) {
            break;
        }
        path.see(world.snapshot());
        if (each) each();
    }
    return path;
}

}  // namespace tumble
