#include "sim/articulation/tree_limits.h"

#include "core/deterministic_math.h"
#include "sim/articulation/settings.h"
#include "sim/joints/joint_set.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Angle, rad, that a ball may be beyond its limit; and the turn, rad, over which the rate of the limit's direction is
/// found. Not fitted: rounding of the angles, and of their differences.
constexpr double limit_of_ball = 1e-12;
constexpr double limit_difference = 1e-3;

}  // namespace

bool TreeLimits::find(const JointTree& tree, const TreeStep& step, TreeClosures& closures) {
    list_.clear();
    tree_ = &tree;
    closures_ = &closures;
    step_ = &step;
    balls_ = false;
    for (int k = 0; k < int(tree.nodes().size()); ++k) {
        const TreeNode& node = tree.nodes()[std::size_t(k)];
        if (node.joint != TreeNode::no_joint && step.joints[std::size_t(node.joint)]->soft) add_joint(tree, k, step);
    }
    return !(balls_ && closures.any_rows()) && std::none_of(list_.begin(), list_.end(), [](const Limit& limit) {
        return limit.room < -tuning::tree_gap * limit.size;
    });
}

// The limits of a node's coordinates.
void TreeLimits::add_joint(const JointTree& tree, int index, const TreeStep& step) {
    const TreeNode& node = tree.nodes()[std::size_t(index)];
    const bool ball = node.kind == NodeKind::ball;
    if (!ball && node.kind != NodeKind::revolute && node.kind != NodeKind::prismatic) return;
    const Joint& joint = *step.joints[std::size_t(node.joint)];
    const std::uint8_t c = ball ? 3 : node.coordinate;
    const JointAxis& axis = joint.axis(c);
    const bool limited = axis.motion == JointAxis::Motion::limited, swings = ball && joint.description.swing;
    if (!limited && !swings) return;
    const JointGeometry g = measure(joint, side_of(step.bodies, joint.a), side_of(step.bodies, joint.b));
    Limit limit;
    limit.node = index;
    limit.joint = node.joint;
    limit.at = node.at;
    limit.speed_at = node.speed_at;
    limit.coordinate = c;
    limit.size = c < 3 ? joint.size : 1.0;
    limit.ball = ball;
    limit.restitution = axis.restitution;
    const bool second = joint.b == step.island[std::size_t(tree.child_of(node.joint))];
    limit.sign = ball ? (second ? 1.0 : -1.0) : node.sign;
    const auto add = [&](Joint::Law law, double room) {
        limit.law = law;
        limit.side = law == Joint::lower ? limit.sign : -limit.sign;
        limit.room = !ball && std::abs(room) <= tuning::tree_gap * limit.size ? 0.0 : room;
        list_.push_back(limit);
        balls_ = balls_ || ball;
    };
    if (limited && axis.lower > -infinity) add(Joint::lower, g.coordinates[c].value - axis.lower);
    if (limited && axis.upper < infinity) add(Joint::upper, axis.upper - g.coordinates[c].value);
    if (!swings) return;
    limit.coordinate = 4;
    limit.restitution = joint.axis(4).restitution;
    add(Joint::cone, g.swing_limit - g.swing.value);
}

bool TreeLimits::needs_rates() const {
    return balls_ || std::any_of(list_.begin(), list_.end(), [](const Limit& limit) { return limit.held; });
}

// `ahead` s later, at the present velocities.
JointGeometry TreeLimits::measure_ball(const Limit& limit, const ForwardDynamics& dynamics, double ahead) const {
    const Joint& joint = *step_->joints[std::size_t(limit.joint)];
    const auto side = [&](std::uint32_t i) {
        const auto found = std::lower_bound(step_->island.begin(), step_->island.end(), i);
        if (i == Joint::world || found == step_->island.end() || *found != i) return side_of(step_->bodies, i);
        const int node = tree_->node_of_body()[std::size_t(found - step_->island.begin())];
        const ForwardDynamics::Link& link = dynamics.link(node);
        JointSide pose{link.position(), link.orientation};
        if (ahead != 0.0) pose.orientation = from_rotation_vector(ahead * link.velocity.turn) * pose.orientation;
        return pose;
    };
    return measure(joint, side(joint.a), side(joint.b));
}

double TreeLimits::room(const Limit& limit, const ForwardDynamics& dynamics, const double* q) const {
    if (!limit.ball) return limit.room + limit.side * q[limit.at];
    const JointGeometry g = measure_ball(limit, dynamics);
    if (limit.law == Joint::cone) return g.swing_limit - g.swing.value;
    const JointAxis& axis = step_->joints[std::size_t(limit.joint)]->axis(3);
    return limit.law == Joint::lower ? g.coordinates[3].value - axis.lower : axis.upper - g.coordinates[3].value;
}

// n: the rate at which the ball leaves the limit is n . w.
Vec3 TreeLimits::inward_of_ball(const Limit& limit, const ForwardDynamics& dynamics, double ahead) const {
    const JointGeometry g = measure_ball(limit, dynamics, ahead);
    const Vec3 n = limit.side * (limit.law == Joint::cone ? g.swing.direction : g.coordinates[3].direction);
    const int parent = tree_->nodes()[std::size_t(limit.node)].parent;
    if (parent == TreeNode::ground) return tree_->ground().conjugate() * n;
    const ForwardDynamics::Link& link = dynamics.link(parent);
    Quat frame = link.orientation;
    if (ahead != 0.0) frame = from_rotation_vector(ahead * link.velocity.turn) * frame;
    return frame.conjugate() * n;
}

// n' . w, by central differences of fourth order.
double TreeLimits::curve_of_ball(const Limit& limit, const ForwardDynamics& dynamics, const double* speeds) const {
    const Vec3 w = Vec3::Map(speeds + limit.speed_at);
    const double fastest = dynamics.link(limit.node).velocity.turn.norm() + w.norm();
    if (!(fastest > 0.0)) return 0.0;
    const double d = limit_difference / fastest;
    const auto difference = [&](double ahead) {
        return (inward_of_ball(limit, dynamics, ahead) - inward_of_ball(limit, dynamics, -ahead)).dot(w);
    };
    return (8.0 * difference(d) - difference(2.0 * d)) / (12.0 * d);
}

// Net effort on a held coordinate, into the allowed range.
double TreeLimits::net_effort(const Limit& limit, const ForwardDynamics& dynamics) const {
    return limit.ball ? -dynamics.holding_torque(limit.node) : limit.side * dynamics.net_effort(limit.node);
}

bool TreeLimits::rests(const Limit& limit, const double* q, const double* speeds) const {
    if (limit.ball) return limit.rests;
    return limit.room + limit.side * q[limit.at] == 0.0 && speeds[limit.speed_at] == 0.0;
}

void TreeLimits::hold(const Limit& limit, ForwardDynamics& dynamics, const double* speeds) const {
    if (limit.ball)
        dynamics.hold_about(limit.node, inward_of_ball(limit, dynamics), -curve_of_ball(limit, dynamics, speeds));
    else
        dynamics.hold(limit.node);
}

// The part of speeds, or of their rates or changes, that leads away from the limit.
double TreeLimits::inwards(std::size_t k, const ForwardDynamics& dynamics, const double* speeds) const {
    const Limit& limit = list_[k];
    if (!limit.ball) return limit.side * speeds[limit.speed_at];
    return inward_of_ball(limit, dynamics).dot(Eigen::Map<const Vec3>(speeds + limit.speed_at));
}

void TreeLimits::begin(const ForwardDynamics& dynamics, double* speeds, double fastest, double length) {
    for (std::size_t k = 0; k < list_.size(); ++k) {
        Limit& limit = list_[k];
        if (!(limit.room <= tuning::tree_gap * limit.size)) continue;
        const double unit = limit.coordinate < 3 ? 1.0 : length;
        if (limit.ball) {
            const double inward = inwards(k, dynamics, speeds);
            limit.rests = std::abs(inward) * unit <= tuning::tree_misfit * fastest;
            if (!limit.rests) continue;
            const Vec3 n = inward_of_ball(limit, dynamics);
            Vec3::Map(speeds + limit.speed_at) -= inward / n.squaredNorm() * n;
        } else if (std::abs(speeds[limit.speed_at]) * unit <= tuning::friction_rest * fastest) {
            speeds[limit.speed_at] = 0.0;
        }
    }
}

void TreeLimits::drive(ForwardDynamics& dynamics, const double* speeds) const {
    for (const Limit& limit : list_)
        if (limit.held) hold(limit, dynamics, speeds);
}

double TreeLimits::excess(std::size_t k, const ForwardDynamics& dynamics, const double* q) const {
    const Limit& limit = list_[k];
    if (limit.held) return net_effort(limit, dynamics) - tuning::friction_let_go * limit.load;
    // The coordinate of a ball cannot be set to its limit.
    if (limit.ball) return limit.rests ? -infinity : -room(limit, dynamics, q) - limit_of_ball;
    return -room(limit, dynamics, q) - tuning::tree_event_located * limit.size;
}

double TreeLimits::unit(std::size_t k) const { return list_[k].held ? list_[k].load : list_[k].size; }

double TreeLimits::passes_at(std::size_t k, const double* q, const double* speeds, const double* end,
                             const double* end_speeds, double h) const {
    const Limit& limit = list_[k];
    if (limit.held || limit.ball) return 0.0;
    const double r0 = limit.room + limit.side * q[limit.at], r1 = limit.room + limit.side * end[limit.at],
                 v0 = limit.side * speeds[limit.speed_at] * h, v1 = limit.side * end_speeds[limit.speed_at] * h;
    if (!(v0 < 0.0) || !(v1 > 0.0)) return 0.0;
    // r0 + v0 t + b t^2 + c t^3, whose rate v0 + 2 b t + 3 c t^2 changes its sign once.
    const double b = 3.0 * (r1 - r0) - 2.0 * v0 - v1, c = v0 + v1 - 2.0 * (r1 - r0);
    double low = 0.0, high = 1.0;
    for (int halving = 0; halving < 30; ++halving) {
        const double t = 0.5 * (low + high);
        (v0 + t * (2.0 * b + 3.0 * c * t) < 0.0 ? low : high) = t;
    }
    return r0 + low * (v0 + low * (b + low * c)) < 0.0 ? low : 0.0;
}

bool TreeLimits::strikes(std::size_t k, const ForwardDynamics& dynamics, const double* q, const double* speeds) const {
    const Limit& limit = list_[k];
    if (!limit.ball) return limit.room + limit.side * q[limit.at] == 0.0 && limit.side * speeds[limit.speed_at] < 0.0;
    return !limit.rests && room(limit, dynamics, q) <= tuning::tree_gap && inwards(k, dynamics, speeds) < 0.0;
}

bool TreeLimits::ends_within(std::size_t k, double approach, double load, double span) const {
    return 2.0 * list_[k].restitution * approach < tuning::limit_hop * span * load;
}

// By the response to a unit impulse: accelerations at rest without forces are changes of speeds.
void TreeLimits::respond(std::size_t k, Impact& impact, ForwardDynamics& dynamics, double* q, double* speeds,
                         std::size_t numbers) {
    Limit& limit = list_[k];
    const Vec3 inward = limit.ball ? inward_of_ball(limit, dynamics) : Vec3(Vec3::Zero());
    if (!limit.ball) q[limit.at] = -limit.side * limit.room;
    std::vector<char> passes(list_.size(), 0);
    for (std::size_t j = 0; j < list_.size(); ++j) {
        passes[j] = j != k && list_[j].node != limit.node && rests(list_[j], q, speeds);
    }
    const std::vector<double> still(numbers, 0.0);
    std::vector<double> change(numbers, 0.0);
    const auto apply = [&](double impulse) {
        dynamics.move(q, still.data());
        for (std::size_t j = 0; j < list_.size(); ++j)
            if (passes[j]) hold(list_[j], dynamics, still.data());
        if (limit.ball)
            dynamics.twist(limit.node, impulse * inward);
        else
            dynamics.drive(limit.node, impulse * limit.side);
        closures_->accelerate(dynamics, Vec3::Zero(), q, change.data());
    };
    for (bool all = false; !all;) {
        apply(1.0);
        all = true;
        for (std::size_t j = 0; j < list_.size(); ++j)
            if (passes[j] && net_effort(list_[j], dynamics) > 0.0) passes[j] = all = false;
    }
    const double gain = limit.ball ? inward.dot(Vec3::Map(&change[std::size_t(limit.speed_at)]))
                                   : limit.side * change[std::size_t(limit.speed_at)];
    const double rebound = impact.rebounds ? limit.restitution * impact.approach : 0.0;
    impact.impulse = (impact.approach + rebound) / gain;
    apply(impact.impulse);
    for (std::size_t i = 0; i < numbers; ++i) speeds[i] += change[i];
    for (std::size_t j = 0; j < list_.size(); ++j) {
        if (passes[j] && !list_[j].ball) speeds[list_[j].speed_at] = 0.0;
        list_[j].held = list_[j].held && passes[j];
        list_[j].rests = list_[j].rests && passes[j];
    }
    limit.rests = rebound == 0.0;
    if (!limit.ball) speeds[limit.speed_at] = limit.side * rebound;
}

TreeLimits::Impact TreeLimits::strike(std::size_t k, ForwardDynamics& dynamics, double* q, double* speeds,
                                      std::size_t numbers, double span, const std::function<const double*()>& rates) {
    const std::vector<double> before(speeds, speeds + numbers);
    const std::vector<Limit> states = list_;
    Impact impact{-inwards(k, dynamics, speeds), 0.0, list_[k].restitution > 0.0};
    if (!(impact.approach > 0.0)) return impact;
    if (impact.rebounds) {
        respond(k, impact, dynamics, q, speeds, numbers);
        const double* after = rates();
        double load = -inwards(k, dynamics, after);
        if (list_[k].ball) load -= curve_of_ball(list_[k], dynamics, speeds);
        impact.rebounds = !ends_within(k, impact.approach, load, span);
        std::copy(before.begin(), before.end(), speeds);
        list_ = states;
    }
    respond(k, impact, dynamics, q, speeds, numbers);
    const double rebound = impact.rebounds ? list_[k].restitution * impact.approach : 0.0;
    list_[k].lost += 0.5 * impact.impulse * (impact.approach - rebound);
    return impact;
}

bool TreeLimits::revise(const ForwardDynamics& dynamics, const double* q, const double* speeds, const double* rates,
                        std::size_t numbers, bool one) {
    double fastest = 0.0;
    for (std::size_t i = 0; i < numbers; ++i) fastest = std::max(fastest, std::abs(rates[i]));
    bool any = false;
    for (std::size_t k = 0; k < list_.size(); ++k) {
        Limit& limit = list_[k];
        if (!rests(limit, q, speeds)) continue;
        const bool before = limit.held;
        if (limit.held) {
            const double net = net_effort(limit, dynamics);
            limit.load = std::max(limit.load, -net);
            limit.held = !(net > 0.5 * tuning::friction_let_go * limit.load);
        } else {
            double inward = inwards(k, dynamics, rates);
            if (limit.ball) inward += curve_of_ball(limit, dynamics, speeds);
            limit.held = inward < -tuning::friction_rest * fastest;
            if (limit.ball && !limit.held) limit.rests = false;
        }
        any = any || limit.held != before;
        if (any && one) break;
    }
    return any;
}

bool TreeLimits::holds_twice() const {
    for (std::size_t k = 0; k + 1 < list_.size(); ++k)
        if (list_[k].ball && list_[k].held && list_[k].node == list_[k + 1].node && list_[k + 1].held) return true;
    return false;
}

void TreeLimits::account(const TreeStep& step, const ForwardDynamics& dynamics) const {
    for (const Limit& limit : list_) {
        Joint& joint = *step.joints[std::size_t(limit.joint)];
        joint.account.step.work.impacts += limit.lost;
        if (limit.held)
            joint.impulse[limit.coordinate][limit.law] =
                (limit.law == Joint::lower ? -1.0 : 1.0) * net_effort(limit, dynamics) * step.h;
    }
}

}  // namespace tumble
