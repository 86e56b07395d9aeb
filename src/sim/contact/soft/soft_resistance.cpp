#include "sim/contact/soft/soft_resistance.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Vector = Eigen::Vector3f;
using Matrix = Eigen::Matrix3f;

Vector of(const soft::Vector3<float>& v) { return {v.x, v.y, v.z}; }

/// Both bodies of a lane.
struct Pair {
    Pair(const soft::Groups& groups, std::size_t group, std::size_t width, std::size_t l, const soft::Bodies& bodies) {
        for (const std::size_t side : {0, 1}) {
            const std::size_t offset = groups.bodies[(2 * group + side) * width + l];
            state[side] = bodies.state + offset;
            moved[side] = (groups.moved[2 * group + side] >> l & 1u) != 0;
            const float* i = bodies.inertia + offset / soft::body_floats * soft::inertia_floats;
            inverse_inertia[side] << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
            if (!moved[side]) inverse_inertia[side].setZero();
        }
    }
    Vector turn(std::size_t side) const { return {state[side][3], state[side][4], state[side][5]}; }
    /// An impulse on B, and its opposite on A.
    void apply(const Vector& impulse) const {
        for (const std::size_t side : {0, 1}) {
            if (!moved[side]) continue;
            const Vector change = (side == 0 ? -1.0f : 1.0f) * (inverse_inertia[side] * impulse);
            for (int k = 0; k < 3; ++k) state[side][3 + k] += change[k];
        }
    }

    float* state[2];
    bool moved[2];
    Matrix inverse_inertia[2];
};

/// Both tangents and the normal as columns.
Matrix axes_of(const soft::ManifoldLane& lane) {
    using Fields = soft::ManifoldRows<float>;
    const Vector n = of(lane.vector(&Fields::normal)), t = of(lane.vector(&Fields::tangent));
    Matrix axes;
    axes << t, n.cross(t), n;
    return axes;
}

soft::ManifoldLane lane_of(const soft::Groups& groups, std::size_t group, std::size_t width, std::size_t l) {
    return {groups.rows + group * soft::group_rows * width + l, width};
}

}  // namespace

void SoftResistance::put(std::size_t lane, const RotationalFriction& levers, std::size_t points, const Vec3& impulse) {
    Lane& put = lanes_[lane];
    put.rolling = float(levers.rolling);
    put.spinning = float(levers.spinning);
    put.points = std::uint8_t(points);
    put.impulse = impulse.cast<float>();
}

void SoftResistance::warm_start(const soft::Groups& groups, std::size_t group, std::size_t width,
                                const soft::Bodies& bodies) const {
    for (std::size_t l = 0; l < width; ++l) {
        const Lane& own = lanes_[group * width + l];
        if (own.points == 0) continue;
        const Vector impulse = axes_of(lane_of(groups, group, width, l)) * own.impulse;
        Pair(groups, group, width, l, bodies).apply(impulse);
    }
}

void SoftResistance::resist(const soft::Groups& groups, std::size_t group, std::size_t width,
                            const soft::Bodies& bodies, bool counts) {
    for (std::size_t l = 0; l < width; ++l) {
        Lane& own = lanes_[group * width + l];
        if (own.points == 0) continue;
        const soft::ManifoldLane lane = lane_of(groups, group, width, l);
        const Pair pair(groups, group, width, l, bodies);
        float load = 0.0f;
        for (std::size_t i = 0; i < own.points; ++i) load += lane.point(i)[&soft::PointRows<float>::impulse];
        const Matrix axes = axes_of(lane);
        const Matrix gives = axes.transpose() * (pair.inverse_inertia[0] + pair.inverse_inertia[1]) * axes;
        const Vector turn = axes.transpose() * (pair.turn(1) - pair.turn(0));
        // One mass for both directions where it rolls: the torque is opposite to the turn.
        const float k11 = gives(0, 0), k22 = gives(1, 1), k12 = gives(0, 1), inverse = 1.0f / (k11 * k22 - k12 * k12);
        Vector next = own.impulse;
        next[0] -= inverse * (k22 * turn[0] - k12 * turn[1]);
        next[1] -= inverse * (k11 * turn[1] - k12 * turn[0]);
        const float limit = own.rolling * load;
        if (next[0] * next[0] + next[1] * next[1] > limit * limit) {
            const float mass = 2.0f / (k11 + k22 + std::sqrt((k11 - k22) * (k11 - k22) + 4.0f * k12 * k12));
            next[0] = own.impulse[0] - mass * turn[0];
            next[1] = own.impulse[1] - mass * turn[1];
            const float size = std::sqrt(next[0] * next[0] + next[1] * next[1]);
            if (size > limit) {
                next[0] *= limit / size;
                next[1] *= limit / size;
            }
        }
        const float spinning = own.spinning * load;
        next[2] = std::clamp(next[2] - turn[2] / gives(2, 2), -spinning, spinning);
        pair.apply(axes * (next - own.impulse));
        own.impulse = next;
        if (counts) own.sum += axes * next;
    }
}

}  // namespace tumble
