#include "sim/joints/joint.h"

#include "core/deterministic_math.h"
#include "core/keyframe_curve.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// An angle with whole turns, the nearest to the last one.
double unwrapped(double angle, double last) { return angle + 2.0 * pi * std::round((last - angle) / (2.0 * pi)); }

Quat nearer(Quat q) {
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    return q;
}

using Coordinates = std::array<JointCoordinate, Joint::coordinates>;

// All angles locked: twice the vector of the relative quaternion, the rotation vector to second order.
void lock_turns(const JointFrames& f, Coordinates& to) {
    const Quat q = nearer(f.turn_a.conjugate() * f.turn_b);
    for (int i = 0; i < 3; ++i) to[std::size_t(3 + i)] = {f.a.col(i), 2.0 * q.vec()[i]};
}

// One free angle, about axis k: that axis of A stays square to the two others of B.
void lock_axis(const JointFrames& f, int k, Coordinates& to) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec3 axis = f.a.col(k), bi = f.b.col(i), bj = f.b.col(j);
    to[std::size_t(3 + i)] = {bj.cross(axis), axis.dot(bj)};
    to[std::size_t(3 + j)] = {axis.cross(bi), -axis.dot(bi)};
}

// One locked angle k: axis i of A stays square to axis j of B, and both are free.
void lock_across(const JointFrames& f, int k, Coordinates& to) {
    const Vec3 first = f.a.col((k + 1) % 3), second = f.b.col((k + 2) % 3);
    to[std::size_t(3 + k)] = {first.cross(second), -first.dot(second)};
}

// Number of free turns; axis of the last free one, and of the last locked one.
struct Turns {
    int free = 0, last_free = 0, last_locked = 0;
};
Turns turns_of(const JointLocks& locks) {
    Turns turns;
    for (int i = 0; i < 3; ++i) {
        const bool locked = locks.has(std::size_t(3 + i));
        (locked ? turns.last_locked : turns.last_free) = i;
        turns.free += !locked;
    }
    return turns;
}

void measure_hinge(const Joint& joint, const JointFrames& f, int k, JointGeometry& g) {
    const Quat q = f.turn_a.conjugate() * f.turn_b;
    const double angle = 2.0 * atan2_stable(q.vec()[k], q.w());
    g.coordinates[std::size_t(3 + k)] = {f.a.col(k), unwrapped(angle, joint.value[std::size_t(3 + k)])};
}

void measure_universal(const Joint& joint, const JointFrames& f, int k, JointGeometry& g) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec3 first = f.a.col(i), second = f.b.col(j), across = first.cross(second);
    const double about_first = atan2_stable(second.dot(f.a.col(k)), second.dot(f.a.col(j)));
    const double about_second = atan2_stable(-f.b.col(i).dot(across), f.b.col(i).dot(first));
    g.coordinates[std::size_t(3 + i)] = {first, unwrapped(about_first, joint.value[std::size_t(3 + i)])};
    g.coordinates[std::size_t(3 + j)] = {second, unwrapped(about_second, joint.value[std::size_t(3 + j)])};
}

// Three free angles: twist about x, and the swing of x as a rotation vector across it (q = swing twist).
void measure_ball(const Joint& joint, const JointFrames& f, JointGeometry& g) {
    const Quat q = nearer(f.turn_a.conjugate() * f.turn_b);
    const double length = hypotenuse(q.w(), q.x());
    const Vec3 xa = f.a.col(0), xb = f.b.col(0);
    const double open = 1.0 + xa.dot(xb);
    // The twist's gradient (xa + xb) / (1 + xa.xb) grows without bound towards a swing of pi.
    const Vec3 twist_direction = (xa + xb) / std::max(open, 1e-3);
    g.coordinates[3] = {twist_direction, unwrapped(2.0 * atan2_stable(q.x(), q.w()), joint.value[3])};
    const Quat twist = length > 0.0 ? Quat(q.w() / length, q.x() / length, 0.0, 0.0) : Quat::Identity();
    const Quat swing = q * twist.conjugate();
    const double sine = hypotenuse(swing.y(), swing.z());
    const double angle = 2.0 * atan2_stable(sine, swing.w()), scale = sine > 0.0 ? angle / sine : 2.0;
    const double sy = scale * swing.y(), sz = scale * swing.z();
    g.coordinates[4] = {f.a.col(1), sy};
    g.coordinates[5] = {f.a.col(2), sz};
    const double half = q.vec().norm();
    g.axes = f.a;
    g.rotation = (half > 0.0 ? 2.0 * atan2_stable(half, q.w()) / half : 2.0) * q.vec();
    if (!joint.description.swing) return;
    const auto [ly, lz] = *joint.description.swing;
    // Elliptic cone: (sy / ly)^2 + (sz / lz)^2 <= 1; across its border along the gradient.
    const Vec3 axis = sine > 0.0 ? Vec3(0.0, sy / (ly * ly), sz / (lz * lz)).normalized() : Vec3(0.0, 1.0, 0.0);
    const double share = hypotenuse(sy / ly, sz / lz);
    g.swing_limit = share > 0.0 ? angle / share : std::min(ly, lz);
    g.swing = {f.a * axis, angle};
}

}  // namespace

void Joint::describe(const JointDescription& joint) {
    description = joint;
    locks = {0, distance(), description.length};
    for (std::size_t k = 0; k < coordinates; ++k)
        if (axis(k).motion == JointAxis::Motion::locked) locks.coordinates |= std::uint8_t(1U << k);
}

void measure_locks(const JointLocks& locks, const JointFrames& f, Coordinates& to) {
    const Vec3 apart = f.anchor_b - f.anchor_a;
    if (locks.distance) {
        const double length = apart.norm();
        if (locks.has(0)) to[0] = {length > 0.0 ? Vec3(apart / length) : Vec3(Vec3::UnitY()), length - locks.length};
        return;
    }
    for (int i = 0; i < 3; ++i)
        if (locks.has(std::size_t(i))) to[std::size_t(i)] = {f.a.col(i), f.a.col(i).dot(apart)};
    const Turns turns = turns_of(locks);
    if (turns.free == 0) lock_turns(f, to);
    if (turns.free == 1) lock_axis(f, turns.last_free, to);
    if (turns.free == 2) lock_across(f, turns.last_locked, to);
}

JointGeometry measure(const Joint& joint, const JointSide& a, const JointSide& b) {
    JointGeometry g;
    JointFrames f;
    f.anchor_a = a.position + a.orientation * joint.anchor_a;
    f.anchor_b = g.point = b.position + b.orientation * joint.anchor_b;
    const Vec3 apart = g.point - f.anchor_a;
    if (joint.distance() && !joint.locked(0)) {
        const double length = apart.norm();
        g.coordinates[0] = {length > 0.0 ? Vec3(apart / length) : Vec3(Vec3::UnitY()), length};
        return g;
    }
    if (!joint.distance()) {
        f.turn_a = a.orientation * joint.frame_a;
        f.turn_b = b.orientation * joint.frame_b;
        f.a = f.turn_a.toRotationMatrix();
        f.b = f.turn_b.toRotationMatrix();
    }
    measure_locks(joint.locks, f, g.coordinates);
    if (joint.distance()) return g;
    for (int i = 0; i < 3; ++i)
        if (!joint.locked(std::size_t(i))) g.coordinates[std::size_t(i)] = {f.a.col(i), f.a.col(i).dot(apart)};
    const Turns turns = turns_of(joint.locks);
    if (turns.free == 1) measure_hinge(joint, f, turns.last_free, g);
    if (turns.free == 2) measure_universal(joint, f, turns.last_locked, g);
    if (turns.free == 3) measure_ball(joint, f, g);
    return g;
}

double twist_of(const Joint& joint, const JointSide& a, const JointSide& b) {
    const Quat q = nearer((a.orientation * joint.frame_a).conjugate() * (b.orientation * joint.frame_b));
    return unwrapped(2.0 * atan2_stable(q.x(), q.w()), joint.value[3]);
}

bool limited(const Joint& joint) {
    if (!joint.soft || joint.gear()) return false;
    if (joint.description.swing) return true;
    for (std::size_t k = 0; k < joint.count(); ++k)
        if (joint.axis(k).motion == JointAxis::Motion::limited) return true;
    return false;
}

bool at_limit(const Joint& joint) {
    if (!joint.soft) return false;
    for (std::size_t k = 0; k < joint.count(); ++k) {
        const JointAxis& axis = joint.axis(k);
        const double near = tuning::joint_rounding * (k < 3 ? joint.size : 1.0);
        if (axis.motion == JointAxis::Motion::limited &&
            (joint.value[k] <= axis.lower + near || joint.value[k] >= axis.upper - near))
            return true;
    }
    return false;
}

bool beyond_limit(const Joint& joint, const JointGeometry& g, double tolerance) {
    if (!joint.soft) return false;
    if (joint.description.swing && g.swing.value > g.swing_limit + tolerance) return true;
    for (std::size_t k = 0; k < joint.count(); ++k) {
        const JointAxis& axis = joint.axis(k);
        if (axis.motion != JointAxis::Motion::limited) continue;
        const double value = g.coordinates[k].value, off = tolerance * (k < 3 ? joint.size : 1.0);
        if (value < axis.lower - off || value > axis.upper + off) return true;
    }
    return false;
}

namespace {

// Tangent at a key; zero at both ends, because the target stands still outside of the keys.
double slope_at(const std::vector<JointTarget>& keys, std::size_t i) {
    if (i == 0 || i + 1 == keys.size()) return 0.0;
    using Slope = Eigen::Matrix<double, 1, 1>;
    const double before = keys[i].time - keys[i - 1].time, after = keys[i + 1].time - keys[i].time;
    return smooth_slope<Slope>(Slope((keys[i].value - keys[i - 1].value) / before),
                               Slope((keys[i + 1].value - keys[i].value) / after), before, after)[0];
}

}  // namespace

double motor_target(const JointMotor& motor, double time) {
    const std::vector<JointTarget>& keys = motor.targets;
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), time, [](double t, const JointTarget& key) { return t < key.time; });
    if (next == keys.begin()) return next->value;
    if (next == keys.end()) return keys.back().value;
    const JointTarget& last = next[-1];
    const double span = next->time - last.time, u = (time - last.time) / span, change = next->value - last.value;
    if (motor.interpolation == Interpolation::linear) return last.value + change * u;
    // Hermite basis.
    const double h1 = u * u * (3.0 - 2.0 * u), h2 = u * (1.0 - u) * (1.0 - u), h3 = -u * u * (1.0 - u);
    const auto i = std::size_t(next - keys.begin());
    return last.value + h1 * change + span * (h2 * slope_at(keys, i - 1) + h3 * slope_at(keys, i));
}

}  // namespace tumble
