#include "sim/joints/joint_way.h"

#include "core/sort_unique.h"
#include "sim/joints/joint_groups.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"
#include "sim/joints/spanning_joints.h"
#include "sim/math/block_cholesky.h"

#include <algorithm>

namespace tumble {
namespace {

/// Nets are groups with more joints than bodies, of at least so many bodies and more block products per body in a
/// factorization, or with ropes (distance joints with limits), whose changes between taut and slack need dozens of
/// factorizations in a step. Limits the cost.
constexpr std::size_t net_bodies = 256;
constexpr double net_work = 100.0;
constexpr std::size_t net_bodies_of_ropes = 64;

/// Largest number of bodies of a figure. Not fitted: sweeps carry an impulse along a few joints in a substep, not along
/// a chain of a hundred.
constexpr std::size_t figure_most = 64;

/// Largest compliance at an anchor by a body's turns over that by its mass, for joints that lock or limit turns and for
/// others: sweeps lose its square, and itself, of the digits of single precision. Not fitted: a hundredth of the digits
/// is left.
constexpr double turn_leverage = 300.0;
constexpr double point_leverage = 1e4;

/// Largest ratio of the masses that a joint of a net or figure connects: sweeps stretch joints that hold a heavy body
/// by light ones. Not fitted: far from such loads.
constexpr double net_mass_ratio = 16.0;

bool integrator_known(const Body& body) { return body.integrator == IntegratorKind::symplectic_euler; }

// Largest share by which the body's turns add to the compliance at the anchor of a joint: m tr([r] I^-1 [r]^T).
double leverage(const Body& body, const Vec3& r) {
    const Mat3& w = body.inverse_inertia_body;
    return body.mass * (r.squaredNorm() * w.trace() - r.dot(w * r));
}

// True if single precision has the digits for the compliances of the joint.
bool holds_digits(const Joint& joint, const std::vector<Body>& bodies) {
    bool turns = false;
    for (std::size_t k = 3; k < joint.count(); ++k)
        turns = turns || joint.axis(k).motion != JointAxis::Motion::free || joint.description.swing;
    const double most = turns ? turn_leverage : point_leverage;
    const auto holds = [&](std::uint32_t i, const Vec3& anchor) {
        return i == Joint::world || !bodies[i].dynamic() || leverage(bodies[i], anchor) <= most;
    };
    return holds(joint.a, joint.anchor_a) && holds(joint.b, joint.anchor_b);
}

bool all_known(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    return std::all_of(group.bodies.begin(), group.bodies.end(),
                       [&](std::uint32_t i) { return integrator_known(bodies[i]); }) &&
           std::all_of(group.joints.begin(), group.joints.end(), [&](std::uint32_t k) {
               const Joint& joint = joints.joints()[k];
               return known_to_sweeps(joint) && holds_digits(joint, bodies);
           });
}

bool has_more_joints(const JointGroup& group) { return group.joints.size() > group.bodies.size(); }

bool masses_are_alike(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    const auto dynamic = [&](std::uint32_t i) { return i != Joint::world && bodies[i].dynamic(); };
    return std::all_of(group.joints.begin(), group.joints.end(), [&](std::uint32_t k) {
        const Joint& joint = joints.joints()[k];
        if (!dynamic(joint.a) || !dynamic(joint.b)) return true;
        const double a = bodies[joint.a].mass, b = bodies[joint.b].mass;
        return std::max(a, b) <= net_mass_ratio * std::min(a, b);
    });
}

}  // namespace

bool known_to_sweeps(const Joint& joint) {
    const JointDescription& description = joint.description;
    if (joint.gear() || description.ever_breaks() || description.armature) return false;
    std::size_t rubs = 0;
    bool drives = description.friction_coefficient > 0.0, swing_limited = false;
    for (std::size_t c = 0; c < joint.count(); ++c) {
        const JointAxis& axis = joint.axis(c);
        const bool turns = c >= 3, limited = axis.motion == JointAxis::Motion::limited;
        const bool stops = limited || (turns && description.swing);
        if (axis.motor || (stops && axis.restitution > 0.0)) return false;
        // Dampers and friction of turns alone; no springs.
        if ((axis.spring || axis.friction > 0.0) && !turns) return false;
        if (axis.spring && (joint.springs[c].stiffness > 0.0 || axis.spring->frequency > 0.0)) return false;
        if (!joint.distance() && !turns && axis.motion != JointAxis::Motion::locked) return false;
        drives = drives || axis.spring || axis.friction > 0.0;
        swing_limited = swing_limited || (turns && c > 3 && limited);
        rubs += turns && axis.motion != JointAxis::Motion::locked &&
                (axis.friction > 0.0 || description.friction_coefficient > 0.0);
    }
    if (joint.distance()) return !(description.friction_coefficient > 0.0);
    if (joint.turns_alike()) return !swing_limited || !(drives || description.swing);
    return rubs <= 1 && !description.swing;  // friction has one bound
}

double factor_work(const JointGroup& group, const JointSet& joints) {
    const auto place = [&](std::uint32_t body) {
        const auto found = std::lower_bound(group.bodies.begin(), group.bodies.end(), body);
        return found != group.bodies.end() && *found == body ? std::int64_t(found - group.bodies.begin()) : -1;
    };
    std::vector<BlockCholesky::Pair> pairs;
    for (const std::uint32_t k : group.joints) {
        const Joint& joint = joints.joints()[k];
        const std::int64_t a = place(joint.a), b = place(joint.b);
        if (a >= 0 && b >= 0 && a != b) pairs.push_back({std::uint32_t(a), std::uint32_t(b)});
    }
    BlockCholesky matrix;
    matrix.analyze(group.bodies.size(), pairs);
    return double(matrix.work()) / double(group.bodies.size());
}

namespace {

// True if flight knows the joints of the group.
bool flies(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    std::vector<const Joint*> members;
    for (const std::uint32_t k : group.joints) members.push_back(&joints.joints()[k]);
    return tree_laws(members, bodies) && has_few_loops(group.bodies, members, joints.joints());
}

bool is_net(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies, SweepRule rule) {
    if (rule == SweepRule::all) return true;
    if (!has_more_joints(group) || !masses_are_alike(group, joints, bodies)) return false;
    const bool ropes = std::any_of(group.joints.begin(), group.joints.end(), [&](std::uint32_t k) {
        const Joint& joint = joints.joints()[k];
        return joint.distance() && !joint.locked(0);
    });
    if (ropes && group.bodies.size() >= net_bodies_of_ropes) return true;
    return group.bodies.size() >= net_bodies && factor_work(group, joints) > net_work;
}

// A tree without an anchor, of joints that hold anchors together, between masses that are not too unlike.
bool is_figure(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    return !group.anchored && group.bodies.size() <= figure_most && group.joints.size() + 1 == group.bodies.size() &&
           masses_are_alike(group, joints, bodies) &&
           std::none_of(group.joints.begin(), group.joints.end(),
                        [&](std::uint32_t k) { return joints.joints()[k].distance(); });
}

void add(MechanismFacts& sum, const MechanismFacts& group) {
    sum.flies = sum.flies && group.flies;
    sum.known_to_sweeps = sum.known_to_sweeps && group.known_to_sweeps;
    sum.net = sum.net || group.net;
    sum.entangled = sum.entangled || group.entangled;
    sum.other = sum.other || group.other;
    sum.figures += group.figures;
}

}  // namespace

SweepRule sweep_rule(const SimulationSettings& settings) {
    if (settings.contact_solver == ContactSolverChoice::direct || settings.impacts != ImpactMode::stepped)
        return SweepRule::none;
    return settings.contact_solver == ContactSolverChoice::soft ? SweepRule::all : SweepRule::dear;
}

MechanismFacts facts_of(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies,
                        SweepRule rule) {
    MechanismFacts facts;
    facts.flies = flies(group, joints, bodies);
    facts.known_to_sweeps = rule != SweepRule::none && all_known(group, joints, bodies);
    facts.net = facts.known_to_sweeps && is_net(group, joints, bodies, rule);
    facts.entangled = facts.net && has_more_joints(group);
    if (facts.known_to_sweeps && !facts.net && rule == SweepRule::dear && is_figure(group, joints, bodies))
        facts.figures = group.bodies.size();
    facts.other = !facts.net && facts.figures == 0;
    return facts;
}

JointWay choose_way(const MechanismFacts& mechanism, const ContactFacts& contacts) {
    if (mechanism.net) return mechanism.known_to_sweeps ? JointWay::sweeps : JointWay::direct;
    const bool figures = mechanism.known_to_sweeps && mechanism.figures > 0 && !mechanism.other;
    if (figures && contacts.within_reach && contacts.crowd) return JointWay::sweeps;
    return mechanism.flies && !contacts.touching ? JointWay::free : JointWay::direct;
}

void FigureCrowd::count(std::size_t bodies) {
    if (bodies >= (swept() ? tuning::figures_kept : tuning::figures_swept))
        left_ = tuning::figure_wait;
    else
        left_ -= swept();
}

void Mechanisms::find(const JointSet& joints, const std::vector<Body>& bodies, SweepRule rule) {
    if (found_ == joints.changes()) return;
    found_ = joints.changes();
    const std::vector<JointGroup> found = find_joint_groups(joints, bodies);
    groups_.clear();
    group_.assign(bodies.size(), UINT32_MAX);
    for (const JointGroup& group : found) {
        for (const std::uint32_t i : group.bodies) group_[i] = std::uint32_t(groups_.size());
        groups_.push_back(facts_of(group, joints, bodies, rule));
    }
}

MechanismFacts Mechanisms::facts(std::span<const std::uint32_t> island) const {
    MechanismFacts sum;
    std::vector<std::uint32_t> groups;
    for (const std::uint32_t i : island)
        if (group_[i] != UINT32_MAX && (groups.empty() || groups.back() != group_[i])) groups.push_back(group_[i]);
    sort_unique(groups);
    for (const std::uint32_t g : groups) add(sum, groups_[g]);
    return sum;
}

namespace {

bool motors_fly(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c) {
        const JointAxis& axis = joint.axis(c);
        if (!axis.motor) continue;
        const bool steady = axis.motor->speed ? axis.motor->max_force < infinity && axis.friction == 0.0
                                              : axis.motor->targets.size() == 1;
        if (!steady) return false;
    }
    return true;
}

}  // namespace

bool on_moving_carrier(const Joint& joint, const std::vector<Body>& bodies) {
    for (const std::uint32_t i : {joint.a, joint.b})
        if (i != Joint::world && !bodies[i].dynamic() && bodies[i].moves()) return true;
    return false;
}

bool has_friction(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c)
        if (joint.axis(c).friction > 0.0) return true;
    return false;
}

bool has_springs(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c)
        if (joint.axis(c).spring) return true;
    return false;
}

bool has_motors(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c)
        if (joint.axis(c).motor) return true;
    return false;
}

bool acts_along_coordinates(const Joint& joint) {
    if (!has_springs(joint) && !has_friction(joint) && !has_motors(joint)) return true;
    int turns = 0;
    for (std::size_t c = 3; c < joint.count(); ++c) turns += !joint.locked(c);
    return turns < 3;
}

bool tree_laws(std::span<const Joint* const> joints, const std::vector<Body>& bodies) {
    int anchors = 0, carried = 0;
    for (const Joint* joint : joints) {
        for (const std::uint32_t i : {joint->a, joint->b}) {
            anchors += i == Joint::world || !bodies[i].dynamic();
            if (i != Joint::world && bodies[i].dynamic() && bodies[i].integrator == IntegratorKind::explicit_euler)
                return false;
        }
        if (joint->distance() && (has_motors(*joint) || has_friction(*joint))) return false;
        if (on_moving_carrier(*joint, bodies)) {
            ++carried;
            if (joint->distance()) return false;
        }
        if (joint->broken || (joint->soft && joint->description.friction_coefficient > 0.0) ||
            !acts_along_coordinates(*joint) || !motors_fly(*joint))
            return false;
    }
    return carried == 0 || anchors == 1;
}

IntegratorKind joined_integrator(const std::vector<Body>& bodies, std::span<const std::uint32_t> joined) {
    bool exact = false, splitting = false, runge_kutta = false;
    for (const std::uint32_t i : joined) {
        exact = exact || bodies[i].integrator == IntegratorKind::exact;
        splitting = splitting || bodies[i].integrator == IntegratorKind::splitting;
        runge_kutta = runge_kutta || bodies[i].integrator == IntegratorKind::runge_kutta_4;
    }
    if (exact) return IntegratorKind::exact;
    if (splitting) return IntegratorKind::splitting;
    return runge_kutta ? IntegratorKind::runge_kutta_4 : IntegratorKind::symplectic_euler;
}

}  // namespace tumble
