#include "sim/articulation/tree_friction.h"

#include "sim/articulation/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {

void TreeFriction::find(const JointTree& tree, const TreeStep& step) {
    list_.clear();
    motors_ = 0;
    for (int k = 0; k < int(tree.nodes().size()); ++k) {
        const TreeNode& node = tree.nodes()[std::size_t(k)];
        if (node.kind != NodeKind::revolute && node.kind != NodeKind::prismatic) continue;
        const JointAxis& axis = step.joints[std::size_t(node.joint)]->axis(node.coordinate);
        Friction f;
        f.node = k;
        f.joint = node.joint;
        f.at = node.at;
        f.speed_at = node.speed_at;
        f.coordinate = node.coordinate;
        f.sign = node.sign;
        f.bound = axis.friction;
        if (axis.motor && axis.motor->speed) {
            f.bound = axis.motor->max_force;
            f.speed = node.sign * *axis.motor->speed;
            f.work = motors_++;
        }
        if (f.bound > 0.0) list_.push_back(f);
    }
}

void TreeFriction::begin(double* speeds, double fastest, double length) {
    for (Friction& f : list_) {
        double& speed = speeds[f.speed_at];
        // Angles in m/s of the mean radius; a displacement is not smaller.
        if (std::abs(speed - f.speed) * length <= tuning::friction_rest * fastest) speed = f.speed;
        f.way = speed > f.speed ? 1.0 : speed < f.speed ? -1.0 : 0.0;
    }
}

void TreeFriction::drive(ForwardDynamics& dynamics) const {
    for (const Friction& f : list_) {
        if (f.way == 0.0)
            dynamics.hold(f.node);
        else
            dynamics.drive(f.node, -f.way * f.bound);
    }
}

void TreeFriction::hold(ForwardDynamics& dynamics) const {
    for (const Friction& f : list_)
        if (f.way == 0.0) dynamics.hold(f.node);
}

double TreeFriction::excess(std::size_t k, const ForwardDynamics& dynamics, const double* speeds) const {
    const Friction& f = list_[k];
    if (f.way != 0.0) return -f.way * (speeds[f.speed_at] - f.speed);
    return std::abs(dynamics.net_effort(f.node)) - (1.0 + tuning::friction_let_go) * f.bound;
}

double TreeFriction::unit(std::size_t k, const double* speeds) const {
    const Friction& f = list_[k];
    return f.way != 0.0 ? std::abs(speeds[f.speed_at] - f.speed) : f.bound;
}

double TreeFriction::turns_back_at(std::size_t k, const double* speeds, const double* rates, const double* end_speeds,
                                   const double* end_rates, double h) const {
    const Friction& f = list_[k];
    const auto i = std::size_t(f.speed_at);
    const double v0 = f.way * (speeds[i] - f.speed), v1 = f.way * (end_speeds[i] - f.speed), a0 = f.way * rates[i] * h,
                 a1 = f.way * end_rates[i] * h;
    if (f.way == 0.0 || !(a0 < 0.0) || !(a1 > 0.0)) return 0.0;
    // v0 + a0 t + b t^2 + c t^3, whose rate a0 + 2 b t + 3 c t^2 changes its sign once.
    const double b = 3.0 * (v1 - v0) - 2.0 * a0 - a1, c = a0 + a1 - 2.0 * (v1 - v0);
    double low = 0.0, high = 1.0;
    for (int halving = 0; halving < 30; ++halving) {
        const double t = 0.5 * (low + high);
        (a0 + t * (2.0 * b + 3.0 * c * t) < 0.0 ? low : high) = t;
    }
    return v0 + low * (a0 + low * (b + low * c)) < 0.0 ? low : 0.0;
}

void TreeFriction::change(std::size_t k, const double* q, double* speeds, double net) {
    Friction& f = list_[k];
    f.heat = heat(f, q);
    f.since = q[f.at];
    speeds[f.speed_at] = f.speed;
    f.way = f.way != 0.0 ? 0.0 : net > 0.0 ? 1.0 : -1.0;
}

void TreeFriction::strike(const double* q, const double* speeds) {
    for (Friction& f : list_) {
        f.heat = heat(f, q);
        f.since = q[f.at];
        if (const double speed = speeds[f.speed_at]; speed != f.speed) f.way = speed > f.speed ? 1.0 : -1.0;
    }
}

bool TreeFriction::revise(const ForwardDynamics& dynamics, const double* speeds, const double* rates, bool one) {
    bool any = false;
    for (Friction& f : list_) {
        if (speeds[f.speed_at] != f.speed) continue;
        const double before = f.way;
        if (f.way == 0.0) {
            const double needed = dynamics.net_effort(f.node);
            if (std::abs(needed) > (1.0 + 0.5 * tuning::friction_let_go) * f.bound) f.way = needed > 0.0 ? 1.0 : -1.0;
        } else if (f.way * rates[f.speed_at] < 0.0) {
            f.way = 0.0;
        }
        if (f.way == before) continue;
        any = true;
        if (one) break;
    }
    return any;
}

void TreeFriction::find_powers(const ForwardDynamics& dynamics, const double* speeds, double* powers) const {
    for (const Friction& f : list_)
        if (f.work >= 0) powers[f.work] = effort(f, dynamics) * speeds[f.speed_at];
}

// Along the node's coordinate.
double TreeFriction::effort(const Friction& f, const ForwardDynamics& dynamics) {
    return f.way != 0.0 ? -f.way * f.bound : -dynamics.net_effort(f.node);
}

double TreeFriction::work(const double* q, const double* works) const {
    double sum = 0.0;
    for (const Friction& f : list_) sum += f.work >= 0 ? works[f.work] : -heat(f, q);
    return sum;
}

// A joint that begins to hold has counted its whole work as an impact's.
void TreeFriction::account(const TreeStep& step, const ForwardDynamics& dynamics, const double* q,
                           const double* works) const {
    for (const Friction& f : list_) {
        Joint& joint = *step.joints[std::size_t(f.joint)];
        const bool motor = f.work >= 0;
        (motor ? joint.account.step.work.motors : joint.account.step.work.heat) += motor ? works[f.work] : heat(f, q);
        joint.impulse[f.coordinate][motor ? Joint::motor : Joint::friction] = f.sign * effort(f, dynamics) * step.h;
    }
}

}  // namespace tumble
