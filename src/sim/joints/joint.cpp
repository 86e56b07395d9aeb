#include "sim/joints/joint.h"

#include "core/deterministic_math.h"

#include <cmath>

namespace tumble {
namespace {

// An angle with whole turns, the nearest to the last one.
double unwrapped(double angle, double last) { return angle + 2.0 * pi * std::round((last - angle) / (2.0 * pi)); }

Quat nearer(Quat q) {
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    return q;
}

struct Frames {
    Quat qa, qb;
    Mat3 a, b;  // columns: axes of the joint frames, world
};

// All angles locked: twice the vector of the relative quaternion, the rotation vector to second order.
void measure_fixed(const Frames& f, JointGeometry& g) {
    const Quat q = nearer(f.qa.conjugate() * f.qb);
    for (int i = 0; i < 3; ++i) g.coordinates[std::size_t(3 + i)] = {f.a.col(i), 2.0 * q.vec()[i]};
}

// One free angle, about axis k: that axis of A stays square to the two others of B.
void measure_hinge(const Joint& joint, const Frames& f, int k, JointGeometry& g) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec3 axis = f.a.col(k), bi = f.b.col(i), bj = f.b.col(j);
    g.coordinates[std::size_t(3 + i)] = {bj.cross(axis), axis.dot(bj)};
    g.coordinates[std::size_t(3 + j)] = {axis.cross(bi), -axis.dot(bi)};
    const Quat q = f.qa.conjugate() * f.qb;
    const double angle = 2.0 * atan2_stable(q.vec()[k], q.w());
    g.coordinates[std::size_t(3 + k)] = {axis, unwrapped(angle, joint.value[std::size_t(3 + k)])};
}

// One locked angle k: axis i of A stays square to axis j of B, and both are free.
void measure_universal(const Joint& joint, const Frames& f, int k, JointGeometry& g) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec3 first = f.a.col(i), second = f.b.col(j), across = first.cross(second);
    g.coordinates[std::size_t(3 + k)] = {across, -first.dot(second)};
    const double about_first = atan2_stable(second.dot(f.a.col(k)), second.dot(f.a.col(j)));
    const double about_second = atan2_stable(-f.b.col(i).dot(across), f.b.col(i).dot(first));
    g.coordinates[std::size_t(3 + i)] = {first, unwrapped(about_first, joint.value[std::size_t(3 + i)])};
    g.coordinates[std::size_t(3 + j)] = {second, unwrapped(about_second, joint.value[std::size_t(3 + j)])};
}

// Three free angles: twist about x, and the swing of x as a rotation vector across it (q = swing twist).
void measure_ball(const Joint& joint, const Frames& f, JointGeometry& g) {
    const Quat q = nearer(f.qa.conjugate() * f.qb);
    const double length = std::hypot(q.w(), q.x());
    const Vec3 xa = f.a.col(0), xb = f.b.col(0);
    const double open = 1.0 + xa.dot(xb);
    // The twist's gradient (xa + xb) / (1 + xa.xb) grows without bound towards a swing of pi.
    const Vec3 twist_direction = (xa + xb) / std::max(open, 1e-3);
    g.coordinates[3] = {twist_direction, unwrapped(2.0 * atan2_stable(q.x(), q.w()), joint.value[3])};
    const Quat twist = length > 0.0 ? Quat(q.w() / length, q.x() / length, 0.0, 0.0) : Quat::Identity();
    const Quat swing = q * twist.conjugate();
    const double sine = std::hypot(swing.y(), swing.z());
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
    const double share = std::hypot(sy / ly, sz / lz);
    g.swing_limit = share > 0.0 ? angle / share : std::min(ly, lz);
    g.swing = {f.a * axis, angle};
}

}  // namespace

JointGeometry measure(const Joint& joint, const JointSide& a, const JointSide& b) {
    JointGeometry g;
    const Vec3 anchor_a = a.position + a.orientation * joint.anchor_a;
    g.point = b.position + b.orientation * joint.anchor_b;
    const Vec3 apart = g.point - anchor_a;
    if (joint.distance()) {
        const double length = apart.norm();
        const bool locked = joint.locked(0);
        g.coordinates[0] = {length > 0.0 ? Vec3(apart / length) : Vec3(Vec3::UnitY()),
                            locked ? length - joint.description.length : length};
        return g;
    }
    Frames f;
    f.qa = a.orientation * joint.frame_a;
    f.qb = b.orientation * joint.frame_b;
    f.a = f.qa.toRotationMatrix();
    f.b = f.qb.toRotationMatrix();
    for (int i = 0; i < 3; ++i) g.coordinates[std::size_t(i)] = {f.a.col(i), f.a.col(i).dot(apart)};
    int free = 0, last_free = 0, last_locked = 0;
    for (int i = 0; i < 3; ++i) {
        const bool locked = joint.locked(std::size_t(3 + i));
        (locked ? last_locked : last_free) = i;
        free += !locked;
    }
    if (free == 0) measure_fixed(f, g);
    if (free == 1) measure_hinge(joint, f, last_free, g);
    if (free == 2) measure_universal(joint, f, last_locked, g);
    if (free == 3) measure_ball(joint, f, g);
    return g;
}

}  // namespace tumble
