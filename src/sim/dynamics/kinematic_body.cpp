#include "sim/dynamics/kinematic_body.h"

#include "sim/math/keyframe_track.h"

namespace tumble {
namespace {

/// A kinematic body changes its velocity evenly over a step if the mean velocity equals the mean of both ends
/// within this share of the change. A smooth path is off by a share of h^2; most corners of a path are off by more.
/// Related test: Kinematic.NothingCreepsOnARockingPlatform.
constexpr double kinematic_bend = 0.1;

}  // namespace

BodyVelocity place_on_track(Body& body, double now, double next, double h) {
    const auto from = body.track->at(now), to = body.track->at(next);
    body.orientation = from.rotation;
    body.rotation = from.rotation.toRotationMatrix();
    body.position = from.position + body.rotation * body.center_of_mass;
    const Vec3 target = to.position + to.rotation * body.center_of_mass;
    body.velocity = (target - body.position) / h;
    body.angular_velocity = rotation_vector(to.rotation * from.rotation.conjugate()) / h;
    // The initial velocity where the velocity changes linearly; the mean over a kink of the path.
    const auto begin = [](const Vec3& first, const Vec3& mean, const Vec3& last) {
        const Vec3 change = last - first;
        return (first + last - 2.0 * mean).norm() <= kinematic_bend * change.norm() ? Vec3(mean - 0.5 * change) : mean;
    };
    const auto of_center = [&](const KeyframeTrack::Motion& m) {
        return Vec3(m.velocity + m.angular_velocity.cross(m.rotation * body.center_of_mass));
    };
    return {begin(of_center(from), body.velocity, of_center(to)),
            begin(from.angular_velocity, body.angular_velocity, to.angular_velocity)};
}

BodyVelocity velocity_on_track(const Body& body, double time) {
    const auto motion = body.track->at(time);
    return {motion.velocity + motion.angular_velocity.cross(body.position - motion.position), motion.angular_velocity};
}

void carry_along(Body& body, const Body& carrier, double share, double h) {
    const Quat turn = from_rotation_vector((1.0 - share) * h * carrier.angular_velocity);
    const Vec3 center = carrier.position + share * h * carrier.velocity;
    body.position = carrier.position + h * carrier.velocity + turn * (body.position - center);
    if (carrier.angular_velocity.isZero(0.0)) return;
    body.orientation = (turn * body.orientation).normalized();
    body.rotation = body.orientation.toRotationMatrix();
    body.derive();
}

}  // namespace tumble
