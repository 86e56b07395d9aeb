#include "sim/contact/direct/lock_tree.h"

#include <cmath>

namespace tumble {
namespace {

// Unit vectors that span the complement of `count` unit vectors, which are square to each other but for the error of the
// joint. Returns their number.
int span_rest(const Vec3* locked, int count, Vec3* rest) {
    if (count == 0) {
        for (int k = 0; k < 3; ++k) rest[k] = Vec3::Unit(k);
    } else if (count == 1) {
        int least = 0;
        locked[0].cwiseAbs().minCoeff(&least);
        rest[0] = locked[0].cross(Vec3::Unit(least)).normalized();
        rest[1] = locked[0].cross(rest[0]);
    } else if (count == 2) {
        rest[0] = locked[0].cross(locked[1]).normalized();
    }
    return 3 - count;
}

double power(const SpatialForce& f, const SpatialMotion& a) { return f.moment.dot(a.turn) + f.force.dot(a.move); }

}  // namespace

void LockTree::analyze(FlightLocks& locks) {
    nodes_.clear();
    frees_.clear();
    std::span<const FlightLocks::FlightJoint> joints = locks.joints();
    const std::size_t bodies = locks.bodies().size();
    std::vector<std::vector<std::uint32_t>> joints_of(bodies);
    for (std::uint32_t k = 0; k < joints.size(); ++k)
        for (const std::uint32_t body : {joints[k].a, joints[k].b})
            if (locks.moves(body)) joints_of[body].push_back(k);
    // The root stands still, if a joint leads to such a body.
    bool rooted = false;
    for (std::uint32_t k = 0; k < joints.size(); ++k) {
        const bool moves_a = locks.moves(joints[k].a), moves_b = locks.moves(joints[k].b);
        if (moves_a && moves_b) continue;
        rooted = true;
        Node& node = nodes_.emplace_back();
        node.body = moves_a ? joints[k].a : joints[k].b;
        node.joint = k;
        add_children(locks, joints_of, std::uint32_t(nodes_.size() - 1));
    }
    if (!rooted && bodies > 0) {
        nodes_.emplace_back().body = 0;
        add_children(locks, joints_of, 0);
    }
    for (Node& node : nodes_) {
        const std::uint32_t locked = node.joint == none ? 0 : joints[node.joint].count;
        node.side = node.joint == none || joints[node.joint].b == node.body ? 1.0 : -1.0;
        node.first = std::uint32_t(frees_.size());
        node.count = 6 - locked;
        frees_.resize(frees_.size() + node.count);
    }
}

// Depth first: a chain is listed from one end to the other.
void LockTree::add_children(FlightLocks& locks, const std::vector<std::vector<std::uint32_t>>& joints_of,
                            std::uint32_t root) {
    std::vector<Node> waiting;
    const auto wait_for = [&](std::uint32_t parent) {
        const Node& node = nodes_[parent];
        const std::vector<std::uint32_t>& at = joints_of[node.body];
        for (std::size_t k = at.size(); k-- > 0;) {
            const FlightLocks::FlightJoint& j = locks.joints()[at[k]];
            if (at[k] == node.joint || !locks.moves(j.a) || !locks.moves(j.b)) continue;
            Node& child = waiting.emplace_back();
            child.body = j.a == node.body ? j.b : j.a;
            child.joint = at[k];
            child.parent = parent;
        }
    };
    wait_for(root);
    while (!waiting.empty()) {
        nodes_.push_back(waiting.back());
        waiting.pop_back();
        wait_for(std::uint32_t(nodes_.size() - 1));
    }
}

// From the center of mass to the reference point.
Vec3 LockTree::arm_of(FlightLocks& locks, const Node& node) {
    if (node.joint == none) return Vec3::Zero();
    const FlightLocks::FlightJoint& j = locks.joints()[node.joint];
    return node.side > 0.0 ? j.arm_b : j.arm_a;
}

void LockTree::take(FlightLocks& locks, std::size_t i) {
    Node& node = nodes_[i];
    const FlightBody& body = locks.body(node.body);
    const Vec3 arm = arm_of(locks, node);
    node.lever.setZero();
    if (node.parent != none) {
        const FlightLocks::FlightJoint& j = locks.joints()[node.joint];
        node.lever = (node.side > 0.0 ? j.arm_a : j.arm_b) - arm_of(locks, nodes_[node.parent]);
    }
    // The inertia of the body alone, about its reference.
    const double m = body.mass, square = m * arm.squaredNorm();
    const Vec3 c = -m * arm;
    Sym3 turning = body.spherical_top ? symmetric(body.inertia_body)
                                      : symmetric(body.rotation * body.inertia_body * body.rotation.transpose());
    turning.add_outer(-m, arm);
    turning.xx += square;
    turning.yy += square;
    turning.zz += square;
    node.inertia.turning = turning;
    node.inertia.mixed << 0.0, -c[2], c[1], c[2], 0.0, -c[0], -c[1], c[0], 0.0;
    node.inertia.moving = {m, 0.0, 0.0, m, 0.0, m};
    node.push = {};
    list_frees(locks, node);
    factored_ = false;
}

void LockTree::list_frees(FlightLocks& locks, const Node& node) {
    Vec3 moves[3], turns[3], rest[3];
    int moving = 0, turning = 0;
    if (node.joint != none)
        for (const FlightLocks::Lock& lock : locks.locks(locks.joints()[node.joint]))
            (lock.turns ? turns[turning++] : moves[moving++]) = lock.direction;
    Free* free = frees_.data() + node.first;
    for (int k = 0, n = span_rest(turns, turning, rest); k < n; ++k, ++free) {
        free->direction = rest[k];
        free->turns = true;
    }
    for (int k = 0, n = span_rest(moves, moving, rest); k < n; ++k, ++free) {
        free->direction = rest[k];
        free->turns = false;
    }
}

// Adds the inertia of the subtree to that of the parent. Each free direction s takes I s (I s)^T / (s . I s) from it.
bool LockTree::eliminate(Node& node) {
    SpatialInertia passed = node.inertia;
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        Free& free = frees_[k];
        const Vec3& s = free.direction;
        if (free.turns)
            free.inertia = {passed.turning * s, passed.mixed.transpose() * s};
        else
            free.inertia = {passed.mixed * s, passed.moving * s};
        const double inertia = along(free, free.inertia);
        if (!(inertia > 0.0)) return false;
        free.pivot = 1.0 / inertia;
        passed.subtract_outer(free.inertia, free.pivot);
    }
    if (node.parent != none && node.count < 6) nodes_[node.parent].inertia += passed.shifted(node.lever);
    return true;
}

// Adds the impulses that the subtree passes on to those on the parent.
void LockTree::gather(FlightLocks& locks, Node& node) {
    node.asked = {};
    if (node.joint != none)
        for (const FlightLocks::Lock& lock : locks.locks(locks.joints()[node.joint]))
            (lock.turns ? node.asked.turn : node.asked.move) +=
                node.side * lock.asked / locks.unit(lock) * lock.direction;
    const SpatialForce needed = node.inertia * node.asked;
    SpatialForce push{node.push.moment - needed.moment, node.push.force - needed.force};
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        Free& free = frees_[k];
        free.effort = along(free, push);
        push.moment -= free.pivot * free.effort * free.inertia.moment;
        push.force -= free.pivot * free.effort * free.inertia.force;
    }
    if (node.parent != none && node.count < 6) nodes_[node.parent].push += shifted(push, node.lever);
}

// The change of the body's velocity from that of its parent, and the impulse of their joint. Returns a sum of the impulses.
double LockTree::spread(FlightLocks& locks, Node& node) {
    SpatialMotion change;
    if (node.parent != none) {
        const SpatialMotion& above = nodes_[node.parent].change;
        change = {above.turn, above.move + above.turn.cross(node.lever)};
    }
    for (std::uint32_t k = node.first + node.count; k-- > node.first;) {
        const Free& free = frees_[k];
        const double speed = free.pivot * (free.effort - power(free.inertia, change));
        (free.turns ? change.turn : change.move) += speed * free.direction;
    }
    change.turn += node.asked.turn;
    change.move += node.asked.move;
    node.change = change;
    double sum = 0.0;
    if (node.joint != none) {
        const SpatialForce whole = node.inertia * change;
        const Vec3 force = node.side * (whole.force - node.push.force),
                   torque = node.side * (whole.moment - node.push.moment);
        const FlightLocks::FlightJoint& j = locks.joints()[node.joint];
        Vec3 given_force = Vec3::Zero(), given_torque = Vec3::Zero();  // along the locks alone
        for (FlightLocks::Lock& lock : locks.locks(j)) {
            const double part = lock.direction.dot(lock.turns ? torque : force);
            lock.given += part / locks.unit(lock);
            (lock.turns ? given_torque : given_force) += part * lock.direction;
            sum += lock.given;
        }
        locks.give(j, given_force, given_torque);
    }
    node.push = {};
    return sum;
}

bool LockTree::solve(FlightLocks& locks) {
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        if (!factored_ && !eliminate(nodes_[i])) return false;
        gather(locks, nodes_[i]);
    }
    factored_ = true;
    double sum = 0.0;
    for (Node& node : nodes_) sum += spread(locks, node);
    return std::isfinite(sum);
}

void LockTree::changes(FlightLocks& locks, std::vector<double>& du) const {
    for (const Node& node : nodes_) {
        const SpatialMotion& change = node.change;
        contact_rows::three(du, 6 * node.body) = change.move - change.turn.cross(arm_of(locks, node));
        contact_rows::three(du, 6 * node.body + 3) = locks.length() * change.turn;
    }
}

}  // namespace tumble
