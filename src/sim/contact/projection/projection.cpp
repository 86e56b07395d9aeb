#include "sim/contact/projection/projection.h"

#include "sim/joints/settings.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// The passes end when all locked coordinates are closed to this share of the smaller body. There is one in any case,
/// otherwise bodies at rest would drift apart and jump back. Not fitted: below the error of a step.
constexpr double projection_closed = 2e-5;

/// Largest number of passes. Each squares the error, in sizes of the body. Not fitted: three close 0.3 sizes.
constexpr int projection_passes = 4;

/// Errors below this share of the smaller body are closed with the inertias of the pass before. Not fitted: the next
/// error is at most this share of the last one.
constexpr double projection_small = 0.01;

/// Joints that are open by more than this share of the smaller body are pulled in by tuning::joint_correction_share of
/// it in a step, as anchors that were placed apart. Not fitted: bodies that turn by a radian in a step open their
/// joints by less.
constexpr double projection_wide = 1.0;

double along(const Vec3& direction, bool turns, const SpatialForce& f) {
    return direction.dot(turns ? f.moment : f.force);
}

// Unit vectors that span what `count` locked directions leave.
int add_rest(const Vec3* locked, int count, Vec3* rest) {
    if (count == 0)
        for (int k = 0; k < 3; ++k) rest[k] = Vec3::Unit(k);
    if (count == 1) {
        rest[0] = locked[0].unitOrthogonal();
        rest[1] = locked[0].cross(rest[0]).normalized();
    }
    if (count == 2) rest[0] = locked[0].cross(locked[1]).normalized();
    return 3 - count;
}

}  // namespace

void Projection::find(const JointSet& joints, const std::vector<Body>& bodies) {
    if (found_ == joints.changes()) return;
    found_ = joints.changes();
    nodes_.clear();
    trees_.clear();
    tree_of_.assign(bodies.size(), none);
    loops_.assign(bodies.size(), 0);
    for (const JointGroup& group : find_joint_groups(joints, bodies)) {
        const bool geared = std::any_of(group.joints.begin(), group.joints.end(),
                                        [&](std::uint32_t k) { return joints.joints()[k].gear(); });
        if (!geared && group.joints.size() + 1 == group.bodies.size() + group.anchored)
            add_tree(group, joints, bodies);
        else
            for (const std::uint32_t i : group.bodies) loops_[i] = 1;
    }
}

// Breadth first, from the anchor or the lowest body.
void Projection::add_tree(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    const std::size_t first = nodes_.size();
    const auto dynamic = [&](std::uint32_t i) { return i != Joint::world && bodies[i].dynamic(); };
    const auto place = [&](std::uint32_t i) {
        return std::size_t(std::lower_bound(group.bodies.begin(), group.bodies.end(), i) - group.bodies.begin());
    };
    std::vector<std::vector<std::uint32_t>> joints_of(group.bodies.size());
    for (const std::uint32_t k : group.joints)
        for (const std::uint32_t i : {joints.joints()[k].a, joints.joints()[k].b})
            if (dynamic(i)) joints_of[place(i)].push_back(k);
    std::vector<std::uint32_t> joint_of;  // by node
    const auto add = [&](std::uint32_t body, std::uint32_t parent, std::uint32_t k) {
        Node& node = nodes_.emplace_back();
        node.body = body;
        node.parent = parent;
        joint_of.push_back(k);
        if (k == none) return;
        const Joint& joint = joints.joints()[k];
        node.joined = true;
        node.is_b = joint.b == body;
        node.still = parent == none ? (node.is_b ? joint.a : joint.b) : none;
        node.locks = joint.locks;
        if (joint.distance()) node.locks.coordinates &= 1;
        node.turns_free = node.locks.coordinates < 8;
        node.size = joint.size;
        node.anchor_a = joint.anchor_a;
        node.anchor_b = joint.anchor_b;
        node.frame_a = joint.frame_a;
        node.frame_b = joint.frame_b;
    };
    for (const std::uint32_t k : group.joints) {
        const Joint& joint = joints.joints()[k];
        if (!dynamic(joint.a) || !dynamic(joint.b)) add(dynamic(joint.a) ? joint.a : joint.b, none, k);
    }
    if (nodes_.size() == first) add(group.bodies[0], none, none);
    for (std::size_t i = first; i < nodes_.size(); ++i)
        for (const std::uint32_t k : joints_of[place(nodes_[i].body)]) {
            if (k == joint_of[i - first]) continue;
            const Joint& joint = joints.joints()[k];
            add(joint.a == nodes_[i].body ? joint.b : joint.a, std::uint32_t(i - first), k);
        }
    tree_of_[group.bodies[0]] = std::uint32_t(trees_.size());
    trees_.push_back({first, nodes_.size()});
}

// Loads the inertia of the body alone.
void Projection::load_inertia(const Body& body, Link& link) {
    const Vec3& arm = link.arm;
    const double m = body.mass, square = m * arm.squaredNorm();
    const Vec3 c = -m * arm;
    Sym3 turning = body.spherical_top ? symmetric(body.inertia_body)
                                      : symmetric(link.rotation * body.inertia_body * link.rotation.transpose());
    turning.add_outer(-m, arm);
    turning.xx += square;
    turning.yy += square;
    turning.zz += square;
    link.inertia.turning = turning;
    link.inertia.mixed << 0.0, -c[2], c[1], c[2], 0.0, -c[0], -c[1], c[0], 0.0;
    link.inertia.moving = {m, 0.0, 0.0, m, 0.0, m};
}

// The error of the node's joint at the present poses, in sizes, and the displacement that closes it. `refresh`: finds
// the free directions and the inertia too.
double Projection::measure(const Tree& tree, std::size_t i, const std::vector<Body>& bodies, double h,
                           std::vector<Link>& links, bool refresh) const {
    const Node& node = nodes_[tree.first + i];
    Link& link = links[i];
    link.asked = {};
    link.impulse = {};
    double worst = 0.0;
    Vec3 moves[3], turns[3], rest[3];
    int moving = 0, turning = 0;
    if (node.joined) {
        Vec3 position = Vec3::Zero();
        Quat orientation = Quat::Identity();
        Mat3 rotation = Mat3::Identity();
        if (node.parent != none) {
            const Link& parent = links[node.parent];
            position = parent.position;
            orientation = parent.orientation;
            rotation = parent.rotation;
        } else if (node.still != Joint::world) {
            const Body& still = bodies[node.still];
            position = still.position + h * still.velocity;
            orientation = (from_rotation_vector(h * still.angular_velocity) * still.orientation).normalized();
            rotation = orientation.toRotationMatrix();
        }
        const auto turn_of = [&](bool own) { return own ? link.orientation : orientation; };
        const auto place_of = [&](bool own, const Vec3& anchor) -> Vec3 {
            return own ? link.position + link.rotation * anchor : position + rotation * anchor;
        };
        JointFrames frames;
        frames.anchor_a = place_of(!node.is_b, node.anchor_a);
        frames.anchor_b = place_of(node.is_b, node.anchor_b);
        // Anchors that stay together need no axes.
        if (!node.turns_free || (node.locks.coordinates & 7) != 7) {
            frames.turn_a = turn_of(!node.is_b) * node.frame_a;
            frames.turn_b = turn_of(node.is_b) * node.frame_b;
            frames.a = frames.turn_a.toRotationMatrix();
            frames.b = frames.turn_b.toRotationMatrix();
        }
        std::array<JointCoordinate, Joint::coordinates> coordinates;
        measure_locks(node.locks, frames, coordinates);
        if (refresh) link.reference = frames.anchor_b;
        const double side = node.is_b ? -1.0 : 1.0;
        double most = 0.0;
        for (std::size_t k = 0; k < Joint::coordinates; ++k) {
            if (!node.locks.has(k)) continue;
            const auto& [direction, value] = coordinates[k];
            const bool angle = k >= 3;
            (angle ? turns[turning++] : moves[moving++]) = direction;
            (angle ? link.asked.turn : link.asked.move) += side * value * direction;
            most = std::max(most, std::abs(value) / (angle ? 1.0 : node.size));
        }
        if (most > projection_wide) {
            link.asked.turn *= tuning::joint_correction_share;
            link.asked.move *= tuning::joint_correction_share;
        }
        worst = most;
    } else if (refresh) {
        link.reference = link.position;
    }
    if (!refresh) return worst;
    const Vec3 above = node.parent == none ? link.reference : links[node.parent].reference;
    link.lever = link.reference - above;
    link.arm = link.reference - link.position;
    load_inertia(bodies[node.body], link);
    link.frees = 0;
    const auto add = [&](const Vec3* locked, int count, bool angle) {
        for (int k = 0, n = add_rest(locked, count, rest); k < n; ++k) {
            link.free[link.frees].direction = rest[k];
            link.free[link.frees++].turns = angle;
        }
    };
    add(turns, turning, true);
    add(moves, moving, false);
    return worst;
}

bool Projection::eliminate(Link& link, Link* parent) {
    SpatialInertia passed = link.inertia;
    for (int k = 0; k < link.frees; ++k) {
        Free& free = link.free[k];
        const Vec3& s = free.direction;
        if (free.turns)
            free.inertia = {passed.turning * s, passed.mixed.transpose() * s};
        else
            free.inertia = {passed.mixed * s, passed.moving * s};
        const double inertia = along(s, free.turns, free.inertia);
        if (!(inertia > 0.0)) return false;
        free.pivot = 1.0 / inertia;
        if (parent || k + 1 < link.frees) passed.subtract_outer(free.inertia, free.pivot);
    }
    if (parent && link.frees < 6) parent->inertia.add_shifted(passed, link.lever);
    return true;
}

void Projection::gather(Link& link, Link* parent) {
    const SpatialForce needed = link.inertia * link.asked;
    SpatialForce impulse{link.impulse.moment - needed.moment, link.impulse.force - needed.force};
    for (int k = 0; k < link.frees; ++k) {
        Free& free = link.free[k];
        free.effort = along(free.direction, free.turns, impulse);
        impulse.moment -= free.pivot * free.effort * free.inertia.moment;
        impulse.force -= free.pivot * free.effort * free.inertia.force;
    }
    if (parent && link.frees < 6) parent->impulse += tumble::shifted(impulse, link.lever);
}

void Projection::spread(Link& link, const Link* parent) {
    SpatialMotion change;
    if (parent) change = {parent->change.turn, parent->change.move + parent->change.turn.cross(link.lever)};
    for (int k = link.frees; k-- > 0;) {
        const Free& free = link.free[k];
        const double power = free.inertia.moment.dot(change.turn) + free.inertia.force.dot(change.move);
        (free.turns ? change.turn : change.move) += free.pivot * (free.effort - power) * free.direction;
    }
    change.turn += link.asked.turn;
    change.move += link.asked.move;
    link.change = change;
    link.position += change.move - change.turn.cross(link.arm);
    const Quat turn(1.0, 0.5 * change.turn.x(), 0.5 * change.turn.y(), 0.5 * change.turn.z());  // to second order
    link.orientation = (turn * link.orientation).normalized();
    link.rotation = link.orientation.toRotationMatrix();
}

// Returns whether the bodies have moved.
bool Projection::close(const Tree& tree, std::vector<Body>& bodies, double h, std::vector<Link>& links) {
    const std::size_t size = tree.end - tree.first;
    if (links.size() < size) links.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
        const Body& body = bodies[nodes_[tree.first + i].body];
        links[i].position = body.position;
        links[i].orientation = body.orientation;
        links[i].rotation = body.rotation;
    }
    const auto parent_of = [&](std::size_t i) {
        const std::uint32_t parent = nodes_[tree.first + i].parent;
        return parent == none ? nullptr : &links[parent];
    };
    double last = infinity;
    for (int pass = 0; pass < projection_passes; ++pass) {
        const bool refresh = !(last < projection_small);
        double worst = 0.0;
        for (std::size_t i = 0; i < size; ++i) worst = std::max(worst, measure(tree, i, bodies, h, links, refresh));
        if (!std::isfinite(worst)) return false;
        if (worst <= (pass > 0 ? projection_closed : tuning::joint_rounding)) return pass > 0;
        for (std::size_t i = size; i-- > 0;) {
            if (refresh && !eliminate(links[i], parent_of(i))) return false;
            gather(links[i], parent_of(i));
        }
        double sum = 0.0;
        for (std::size_t i = 0; i < size; ++i) {
            spread(links[i], parent_of(i));
            sum += links[i].position.sum() + links[i].rotation.sum();
        }
        if (!std::isfinite(sum)) return false;
        if (worst > projection_wide) return true;
        last = worst;
    }
    return true;
}

Vec3 Projection::close(std::span<const std::uint32_t> island, std::vector<Body>& bodies, double h, std::size_t thread) {
    std::vector<Link>& links = links_[thread];
    Vec3 gained = Vec3::Zero();
    for (const std::uint32_t lowest : island) {
        if (tree_of_[lowest] == none) continue;
        const Tree& tree = trees_[tree_of_[lowest]];
        if (!close(tree, bodies, h, links)) continue;
        for (std::size_t i = tree.first; i < tree.end; ++i) {
            Body& body = bodies[nodes_[i].body];
            const Link& link = links[i - tree.first];
            gained += (link.position - body.position).cross(body.momentum);
            body.position = link.position;
            body.orientation = link.orientation;
            body.rotation = link.rotation;
            body.derive();
        }
    }
    return gained;
}

}  // namespace tumble
