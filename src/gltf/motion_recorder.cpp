#include "gltf/motion_recorder.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// A rotation vector in rad as a rotation.
Quat turn_by(const Vec3& turn) {
    const double angle = turn.norm();
    if (angle == 0.0) return Quat::Identity();
    const SinCos half = sincos(0.5 * angle);
    const Vec3 axis = half.sin / angle * turn;
    return {half.cos, axis.x(), axis.y(), axis.z()};
}

/// A small rotation as a rotation vector, rad.
Vec3 small_turn(const Quat& rotation) { return (rotation.w() < 0.0 ? -2.0 : 2.0) * rotation.vec(); }

/// Derivative of a rotation's coefficients: half the angular velocity times it.
Eigen::Vector4d rate(const Vec3& angular_velocity, const Eigen::Vector4d& rotation) {
    const Vec3 half = 0.5 * angular_velocity;
    return (Quat(0.0, half.x(), half.y(), half.z()) * Quat(rotation)).coeffs();
}

/// The same rotation, with the sign for which a cubic takes the short way from `with`.
Eigen::Vector4d aligned(const Quat& rotation, const Quat& with) {
    return rotation.dot(with) < 0.0 ? -rotation.coeffs() : rotation.coeffs();
}

/// The nearest time in single precision strictly between two others, so that keys have increasing times. Returns
/// infinity if there is none.
double time_between(double time, double before, double after) {
    const float least = std::nextafter(float(before), float(infinity));
    const float most = std::nextafter(float(after), -float(infinity));
    return least <= most ? double(std::clamp(float(time), least, most)) : infinity;
}

}  // namespace

Quat camera_rotation(const CameraDescription& camera) {
    Mat3 axes;
    axes.col(2) = (camera.eye - camera.target).normalized();
    const Vec3 right = camera.up.cross(axes.col(2));
    axes.col(0) = right.isZero(1e-12) ? axes.col(2).unitOrthogonal() : right.normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return Quat(axes).normalized();
}

MotionRecorder::MotionRecorder(const SceneDescription& scene, std::vector<BodyReport> reports, KeyKind kind)
    : scene_(scene),
      reports_(std::move(reports)),
      bodies_(scene.bodies.size(), PoseKeys(kind, true)),
      absent_from_(scene.bodies.size()),
      last_(scene.bodies.size()),
      impacts_(scene.bodies.size()),
      camera_(kind, false) {}

Vec3 MotionRecorder::node_place(std::size_t body) const {
    return scene_.bodies[body].type == BodyType::dynamic ? reports_[body].center_of_mass : Vec3::Zero();
}

MotionRecorder::Pose MotionRecorder::pose_of(std::size_t body, const Snapshot& snapshot) const {
    const BodyState& state = snapshot.bodies[body];
    const bool dynamic = scene_.bodies[body].type == BodyType::dynamic;
    Pose pose{snapshot.time,          dynamic ? state.center_of_mass : state.origin,
              state.velocity,         state.orientation,
              state.angular_velocity, state.angular_momentum};
    if (!dynamic) pose.velocity -= state.angular_velocity.cross(state.center_of_mass - state.origin);
    return pose;
}

void MotionRecorder::add(const Snapshot& snapshot, const CameraDescription& camera, const ContactRecords* records) {
    std::fill(impacts_.begin(), impacts_.end(), Impacts{});
    if (records && started_)
        for (const ImpactRecord& record : records->impacts)
            if (record.when.exact)
                for (const std::size_t body : {record.a, record.b})
                    if (body < impacts_.size() && record.when.time >= last_time_ && record.when.time <= snapshot.time) {
                        Impacts& impacts = impacts_[body];
                        impacts.first = std::min(impacts.first, record.when.time);
                        impacts.last = std::max(impacts.last, record.when.time);
                    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyDescription& body = scene_.bodies[i];
        std::vector<double>& absent = absent_from_[i];
        if (snapshot.bodies[i].absent != (absent.size() % 2 == 1)) absent.push_back(snapshot.time);
        if (body.type == BodyType::fixed && started_) continue;
        Pose now = pose_of(i, snapshot);
        if (started_) now.rotation.coeffs() = aligned(now.rotation, last_[i].rotation);
        if (started_ && body.type == BodyType::dynamic && impacts_[i].first <= impacts_[i].last)
            add_impacts(i, impacts_[i], now);
        if (started_ && body.interpolation == Interpolation::linear) add_keyframes(i, now);
        add_pose(bodies_[i], now);
        last_[i] = now;
        if (!endless(body.shape)) bounds_.add(now.position);
    }
    Pose eye{snapshot.time, camera.eye, Vec3::Zero(), camera_rotation(camera), Vec3::Zero(), Vec3::Zero()};
    if (started_) eye.rotation.coeffs() = aligned(eye.rotation, last_camera_);
    last_camera_ = eye.rotation;
    add_pose(camera_, eye);
    last_time_ = snapshot.time;
    started_ = true;
}

/// The pose in free flight under gravity, at a time near that of `from`: the rotation is that of the middle of the
/// time, an error of its third power.
MotionRecorder::Pose MotionRecorder::flown(std::size_t body, const Pose& from, double time) const {
    const double t = time - from.time;
    const Vec3 gravity = scene_.bodies[body].gravity_scale * scene_.simulation.gravity;
    const Mat3 inverse = reports_[body].inertia.inverse();
    const auto spin = [&](const Quat& q) -> Vec3 { return q * (inverse * (q.conjugate() * from.angular_momentum)); };
    Pose pose = from;
    pose.time = time;
    pose.position += t * (from.velocity + 0.5 * t * gravity);
    pose.velocity += t * gravity;
    const Quat half = turn_by(0.5 * t * spin(from.rotation)) * from.rotation;
    pose.rotation = (turn_by(t * spin(half)) * from.rotation).normalized();
    pose.angular_velocity = spin(pose.rotation);
    return pose;
}

/// Adds the poses at the first and the last impact of a body since its last moment. Several impacts in between are less
/// than a moment apart.
void MotionRecorder::add_impacts(std::size_t body, const Impacts& impacts, const Pose& now) {
    const Pose& last = last_[body];
    const double first_time = time_between(impacts.first, last.time, now.time);
    const double last_time = time_between(impacts.last, last.time, now.time);
    if (first_time == infinity) return;
    const Pose first = flown(body, last, first_time);
    const Pose second = flown(body, now, last_time);
    if (first_time == last_time) {
        // Otherwise the body did not fly before or after the impact: a landing.
        if ((first.position - second.position).norm() <= key_tolerance &&
            small_turn(second.rotation * first.rotation.conjugate()).norm() <= key_rotation_tolerance)
            add_corner(body, first, second);
        return;
    }
    const double span = last_time - first_time;
    Pose start = first, end = second;
    start.velocity = end.velocity = (second.position - first.position) / span;
    start.angular_velocity = end.angular_velocity = small_turn(second.rotation * first.rotation.conjugate()) / span;
    add_corner(body, first, start);
    add_corner(body, end, second);
}

/// Adds the keyframes of a kinematic body since its last moment, where its velocity changes at once.
void MotionRecorder::add_keyframes(std::size_t body, const Pose& now) {
    for (const Keyframe& keyframe : scene_.bodies[body].keyframes) {
        const Pose& last = last_[body];
        const double time = time_between(keyframe.time, last.time, now.time);
        if (!(keyframe.time > last.time && keyframe.time < now.time) || time == infinity) continue;
        Pose before{time,
                    keyframe.position,
                    (keyframe.position - last.position) / (time - last.time),
                    keyframe.rotation,
                    last.angular_velocity,
                    Vec3::Zero()};
        Pose after = before;
        after.velocity = (now.position - keyframe.position) / (now.time - time);
        after.angular_velocity = now.angular_velocity;
        add_corner(body, before, after);
    }
}

/// Adds a moment with a pose and two velocities.
void MotionRecorder::add_corner(std::size_t body, const Pose& before, const Pose& after) {
    PoseKeys& keys = bodies_[body];
    keys.position.add({before.time, before.position, before.velocity, after.velocity, true});
    const Eigen::Vector4d rotation = aligned(before.rotation, last_[body].rotation);
    keys.rotation.add(
        {before.time, rotation, rate(before.angular_velocity, rotation), rate(after.angular_velocity, rotation), true});
    last_[body] = after;
    last_[body].rotation.coeffs() = rotation;
}

void MotionRecorder::add_pose(PoseKeys& keys, const Pose& pose) {
    keys.position.add({pose.time, pose.position, pose.velocity, pose.velocity, false});
    const Eigen::Vector4d rotation = pose.rotation.coeffs();
    const Eigen::Vector4d derivative = rate(pose.angular_velocity, rotation);
    keys.rotation.add({pose.time, rotation, derivative, derivative, false});
}

void MotionRecorder::finish() {
    for (PoseKeys& keys : bodies_) {
        keys.position.finish();
        keys.rotation.finish();
    }
    camera_.position.finish();
    camera_.rotation.finish();
}

double MotionRecorder::position_error() const {
    double error = camera_.position.error();
    for (const PoseKeys& keys : bodies_) error = std::max(error, keys.position.error());
    return error;
}

double MotionRecorder::rotation_error() const {
    double error = camera_.rotation.error();
    for (const PoseKeys& keys : bodies_) error = std::max(error, keys.rotation.error());
    return error;
}

}  // namespace tumble
