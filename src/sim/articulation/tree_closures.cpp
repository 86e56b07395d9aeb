#include "sim/articulation/tree_closures.h"

#include "sim/articulation/settings.h"
#include "sim/joints/gear.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// A point of a link, or of the ground.
Vec3 velocity_at(const ForwardDynamics::Link& link, const Vec3& point) {
    return link.velocity.move + link.velocity.turn.cross(point - link.point);
}

Vec3 acceleration_at(const ForwardDynamics::Link& link, const Vec3& point) {
    const Vec3 arm = point - link.point;
    return link.acceleration.move + link.acceleration.turn.cross(arm) +
           link.velocity.turn.cross(link.velocity.turn.cross(arm));
}

}  // namespace

TreeClosures::Side TreeClosures::side_at(std::uint32_t body, const Vec3& anchor, const Quat& frame,
                                         const TreeStep& step) const {
    Side side;
    side.anchor = anchor;
    side.frame = frame;
    const auto found = std::lower_bound(step.island.begin(), step.island.end(), body);
    if (body == Joint::world || found == step.island.end() || *found != body) {
        side.pose = side_of(step.bodies, body);
        side.pose.position -= tree_->origin();
    } else {
        side.body = int(found - step.island.begin());
        side.node = tree_->node_of_body()[std::size_t(side.body)];
    }
    return side;
}

// The nodes above both sides move them alike.
void TreeClosures::find_paths(Part& part) const {
    const auto path_of = [&](int node) {
        std::vector<int> path;
        for (; node != TreeNode::ground; node = tree_->nodes()[std::size_t(node)].parent) path.push_back(node);
        return path;
    };
    part.a.path = path_of(part.a.node);
    part.b.path = path_of(part.b.node);
    while (!part.a.path.empty() && !part.b.path.empty() && part.a.path.back() == part.b.path.back()) {
        part.a.path.pop_back();
        part.b.path.pop_back();
    }
}

bool TreeClosures::add_joint(int index, const TreeStep& step, double stage) {
    const Joint& joint = *step.joints[std::size_t(index)];
    Part part;
    part.joint = part.of = index;
    part.a = side_at(joint.a, joint.anchor_a, joint.frame_a, step);
    part.b = side_at(joint.b, joint.anchor_b, joint.frame_b, step);
    find_paths(part);
    if (joint.distance() && !joint.locked(0)) {
        if (limited(joint) && joint.impulse[0][Joint::upper] != 0.0) return false;
        if (limited(joint) && joint.impulse[0][Joint::lower] != 0.0) return false;
        if (joint.axis(0).spring) {
            const JointSpring& spring = joint.springs[0];
            part.spring = true;
            part.stiffness = spring.stiffness;
            part.damping = spring.damping;
            part.rest = spring.rest;
            part.stored = JointSet::potential(joint, step.bodies);
            const JointGeometry g = measure(joint, side_of(step.bodies, joint.a), side_of(step.bodies, joint.b));
            const double gives = compliance_along(step.bodies, joint, g, 0);
            const double rate = std::sqrt(spring.stiffness * gives);
            if (stage * rate > tuning::joint_flight_spring || stage * spring.damping * gives > 0.5) return false;
            fastest_ = std::max(fastest_, rate + spring.damping * gives);
        }
    }
    for (std::size_t c = 0; c < joint.count(); ++c) {
        if (!joint.locked(c)) continue;
        Row& row = rows_.emplace_back();
        row.part = int(parts_.size());
        row.coordinate = std::uint8_t(c);
        row.turns = c >= 3;
        row.unit = row.turns ? length_ : 1.0;
        row.size = row.turns ? 1.0 : joint.size;
    }
    parts_.push_back(part);
    return true;
}

void TreeClosures::add_gear(int index, const TreeStep& step) {
    const Joint& gear = *step.joints[std::size_t(index)];
    const GearGeometry g = measure_gear(gear, step.all, [&](std::uint32_t body) { return side_of(step.bodies, body); });
    Row& row = rows_.emplace_back();
    row.part = int(parts_.size());
    for (std::size_t s = 0; s < 2; ++s) {
        const Joint& of = step.all[gear.description.geared[s]];
        Part& part = parts_.emplace_back();
        part.joint = index;
        part.of = tree_->place_of(&of);
        part.gear = true;
        part.second = s == 1;
        part.factor = s == 0 ? 1.0 : gear.description.ratio;
        part.node = tree_->node_of(part.of);
        part.turns = geared_coordinate(of) >= 3;
        part.a = side_at(of.a, of.anchor_a, of.frame_a, step);
        part.b = side_at(of.b, of.anchor_b, of.frame_b, step);
    }
    row.turns = geared_coordinate(step.all[gear.description.geared[0]]) >= 3;
    row.unit = row.turns ? length_ : 1.0;
    row.size = row.turns ? 1.0 : gear.size;
    row.start = g.error;
}

bool TreeClosures::find(const JointTree& tree, const TreeStep& step, double stage) {
    tree_ = &tree;
    joints_ = step.joints;
    length_ = step.length;
    speeds_ = std::size_t(tree.speeds());
    fastest_ = compliance_ = 0.0;
    parts_.clear();
    rows_.clear();
    for (const int index : tree.cut()) {
        if (step.joints[std::size_t(index)]->gear())
            add_gear(index, step);
        else if (!add_joint(index, step, stage))
            return false;
    }
    used_.clear();
    return true;
}

JointSide TreeClosures::pose_of(const Side& side, const ForwardDynamics& dynamics) const {
    if (side.node == TreeNode::ground) return side.pose;
    const ForwardDynamics::Link& link = dynamics.link(side.node);
    return {link.position(), link.orientation};
}

void TreeClosures::linearize_part(Part& part, const ForwardDynamics& dynamics) {
    for (Side* side : {&part.a, &part.b}) {
        if (side->node == TreeNode::ground) {
            side->point = side->pose.position + side->pose.orientation * side->anchor;
            side->rate.setZero();
        } else {
            const ForwardDynamics::Link& link = dynamics.link(side->node);
            side->point = link.position() + link.rotation * side->anchor;
            side->rate = velocity_at(link, side->point);
        }
    }
    if (part.gear) part.axis = dynamics.link(part.node).axis;
    if (!part.spring) return;
    const Vec3 apart = part.b.point - part.a.point;
    const double length = apart.norm();
    const Vec3 n = length > 0.0 ? Vec3(apart / length) : Vec3(Vec3::UnitY());
    const double rate = n.dot(part.b.rate - part.a.rate);
    part.force = (part.stiffness * (part.rest - length) - part.damping * rate) * n;
    part.heat = part.damping * rate * rate;
}

void TreeClosures::linearize(const ForwardDynamics& dynamics, const double* q) {
    for (Part& part : parts_) linearize_part(part, dynamics);
    for (std::size_t r = 0; r < rows_.size();) {
        Row& first = rows_[r];
        const Part& part = parts_[std::size_t(first.part)];
        if (part.gear) {
            first.error = first.start;
            for (int s = 0; s < 2; ++s) {
                const Part& of = parts_[std::size_t(first.part + s)];
                const TreeNode& node = tree_->nodes()[std::size_t(of.node)];
                first.error += of.factor * node.sign * q[node.at];
            }
            ++r;
            continue;
        }
        const Joint& joint = *joints_[std::size_t(part.joint)];
        const JointSide a = pose_of(part.a, dynamics), b = pose_of(part.b, dynamics);
        JointFrames f;
        f.anchor_a = part.a.point;
        f.anchor_b = part.b.point;
        f.turn_a = a.orientation * joint.frame_a;
        f.turn_b = b.orientation * joint.frame_b;
        f.a = f.turn_a.toRotationMatrix();
        f.b = f.turn_b.toRotationMatrix();
        std::array<JointCoordinate, Joint::coordinates> coordinates;
        measure_locks(joint.locks, f, coordinates);
        int free = 0, axis = 0, across = 0;
        for (int i = 0; i < 3; ++i) {
            const bool locked = joint.locked(std::size_t(3 + i));
            (locked ? across : axis) = i;
            free += !locked;
        }
        for (; r < rows_.size() && rows_[r].part == first.part; ++r) {
            Row& row = rows_[r];
            row.direction = coordinates[row.coordinate].direction;
            row.error = coordinates[row.coordinate].value;
            row.sign = 0.0;
            if (!row.turns || free == 0) continue;
            const int i = row.coordinate - 3;  // x in A and y in B stay square
            if (free == 1) {
                const bool is_first = i == (axis + 1) % 3;
                row.x = f.a.col(axis);
                row.y = f.b.col(is_first ? (axis + 2) % 3 : (axis + 1) % 3);
                row.sign = is_first ? 1.0 : -1.0;
            } else {
                row.x = f.a.col((across + 1) % 3);
                row.y = f.b.col((across + 2) % 3);
                row.sign = -1.0;
            }
        }
    }
}

void TreeClosures::drive(ForwardDynamics& dynamics) {
    if (std::none_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.spring; })) return;
    for (Part& part : parts_) {
        linearize_part(part, dynamics);
        for (const Side* side : {&part.a, &part.b}) {
            if (!part.spring || side->node == TreeNode::ground) continue;
            const Vec3 force = side == &part.b ? part.force : Vec3(-part.force);
            dynamics.apply(side->node, {force, (side->point - dynamics.link(side->node).position()).cross(force)});
        }
    }
}

// The second derivative of the row's error, in its unit; after accelerate().
double TreeClosures::acceleration_of(const Row& row, const ForwardDynamics& dynamics, const double* rates) const {
    const Part& part = parts_[std::size_t(row.part)];
    if (part.gear) {
        double sum = 0.0;
        for (int s = 0; s < 2; ++s) {
            const Part& of = parts_[std::size_t(row.part + s)];
            const TreeNode& node = tree_->nodes()[std::size_t(of.node)];
            sum += of.factor * node.sign * rates[node.speed_at];
        }
        return row.unit * sum;
    }
    const ForwardDynamics::Link &a = dynamics.link(part.a.node), &b = dynamics.link(part.b.node);
    const Vec3 &n = row.direction, &w_a = a.velocity.turn, &w_b = b.velocity.turn;
    if (row.turns) {
        const Vec3 moved = row.sign == 0.0
                               ? Vec3(w_a.cross(n))
                               : Vec3(row.sign * (w_b.cross(row.y).cross(row.x) + row.y.cross(w_a.cross(row.x))));
        return row.unit * (n.dot(b.acceleration.turn - a.acceleration.turn) + moved.dot(w_b - w_a));
    }
    const auto at = [&](const Side& side, const ForwardDynamics::Link& link) {
        return side.node == TreeNode::ground ? link.acceleration.move : acceleration_at(link, side.point);
    };
    const Vec3 apart = part.b.point - part.a.point, rate = part.b.rate - part.a.rate;
    const double along = n.dot(at(part.b, b) - at(part.a, a));
    if (joints_[std::size_t(part.joint)]->distance()) {
        const double radial = n.dot(rate);
        return along + (rate.squaredNorm() - radial * radial) / apart.norm();
    }
    const Vec3 turned = w_a.cross(n);
    return along + 2.0 * turned.dot(rate) + (a.acceleration.turn.cross(n) + w_a.cross(turned)).dot(apart);
}

void TreeClosures::add_side(const Side& side, const Row& row, const ForwardDynamics& dynamics, double sign,
                            double* form) const {
    const Vec3 n = sign * row.unit * row.direction;
    const Vec3 point = parts_[std::size_t(row.part)].b.point;
    for (const int index : side.path) {
        const TreeNode& node = tree_->nodes()[std::size_t(index)];
        const ForwardDynamics::Link& link = dynamics.link(index);
        double* to = form + node.speed_at;
        const Vec3 turn = row.turns ? n : Vec3((point - link.point).cross(n));
        if (node.kind == NodeKind::revolute) to[0] += link.axis.dot(turn);
        if (node.kind == NodeKind::prismatic && !row.turns) to[0] += link.axis.dot(n);
        if (node.kind == NodeKind::ball) {
            const Vec3 own = dynamics.link(node.parent).rotation.transpose() * turn;
            for (int k = 0; k < 3; ++k) to[k] += own[k];
        }
        if (node.kind != NodeKind::free) continue;
        for (int k = 0; k < 3; ++k) {
            to[k] += turn[k];
            if (!row.turns) to[3 + k] += n[k];
        }
    }
}

// G at the coordinates of linearize().
void TreeClosures::fill(const ForwardDynamics& dynamics) {
    forms_.assign(rows_.size() * speeds_, 0.0);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        const Row& row = rows_[r];
        double* form = &forms_[r * speeds_];
        const Part& part = parts_[std::size_t(row.part)];
        if (!part.gear) {
            add_side(part.a, row, dynamics, -1.0, form);
            add_side(part.b, row, dynamics, 1.0, form);
            continue;
        }
        for (int s = 0; s < 2; ++s) {
            const Part& of = parts_[std::size_t(row.part + s)];
            const TreeNode& node = tree_->nodes()[std::size_t(of.node)];
            form[node.speed_at] += row.unit * of.factor * node.sign;
        }
    }
}

void TreeClosures::prepare(ForwardDynamics& dynamics, const double* q) {
    const std::size_t m = rows_.size();
    linearize(dynamics, q);
    fill(dynamics);
    columns_.resize(forms_.size());
    dynamics.set_aside();
    for (std::size_t r = 0; r < m; ++r) dynamics.respond_to(&forms_[r * speeds_], &columns_[r * speeds_]);
    dynamics.give_back();
    matrix_.resize(m * m);
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = 0.0;
            for (std::size_t k = 0; k < speeds_; ++k) sum += forms_[i * speeds_ + k] * columns_[j * speeds_ + k];
            matrix_[i * m + j] = matrix_[j * m + i] = sum;
        }
    if (used_.empty()) choose();
    factor();
}

void TreeClosures::accelerate(ForwardDynamics& dynamics, const Vec3& base, const double* q, double* rates,
                              bool same_places) {
    if (!rows_.empty()) dynamics.keep_efforts();
    if (same_places)
        dynamics.respond(base, rates);
    else
        dynamics.accelerate(base, rates);
    if (rows_.empty()) return;
    if (same_places)
        linearize(dynamics, q);
    else
        prepare(dynamics, q);
    std::vector<double> side(rows_.size());
    for (std::size_t r = 0; r < rows_.size(); ++r) side[r] = -acceleration_of(rows_[r], dynamics, rates);
    const std::vector<double> l = solve(side);
    give(l, true);
    dynamics.restore_efforts();
    apply(dynamics);
    dynamics.respond(base, rates);
    give(shared(l), true);
}

double TreeClosures::error() const {
    double worst = 0.0;
    for (const Row& row : rows_) worst = std::max(worst, std::abs(row.error) / row.size);
    return worst;
}

double TreeClosures::place_rounding() const {
    double farthest = 0.0, smallest = infinity;
    for (const Row& row : rows_) {
        farthest = std::max(farthest, parts_[std::size_t(row.part)].b.point.cwiseAbs().maxCoeff());
        smallest = std::min(smallest, joints_[std::size_t(parts_[std::size_t(row.part)].joint)]->size);
    }
    return std::max(tuning::closure_closed, 4.0 * std::numeric_limits<double>::epsilon() * farthest / smallest);
}

std::vector<double> TreeClosures::errors() const {
    std::vector<double> list;
    for (const Row& row : rows_) list.push_back(row.unit * row.error);
    return list;
}

std::vector<double> TreeClosures::speeds_of(const double* u) const {
    std::vector<double> list(rows_.size(), 0.0);
    for (std::size_t r = 0; r < rows_.size(); ++r)
        for (std::size_t k = 0; k < speeds_; ++k) list[r] += forms_[r * speeds_ + k] * u[k];
    return list;
}

}  // namespace tumble
