#include "sim/articulation/joint_tree.h"

#include "core/deterministic_math.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

Quat about(const Vec3& axis, double cosine, double sine) {
    Quat q;
    q.w() = cosine;
    q.vec() = sine * axis;
    return q;
}

/// Cosine and sine of a half angle, from two numbers in their ratio.
std::array<double, 2> unit(double c, double s) {
    const double length = hypotenuse(c, s);
    return length > 0.0 ? std::array{c / length, s / length} : std::array{1.0, 0.0};
}

/// The coordinates of a joint from the parent to the child, as primitive joints.
struct Sequence {
    const Joint& joint;
    bool forward;         // the parent is the joint's first body
    Quat parent, child;   // joint frame to the frame of the body
    Quat relative;        // of the child's joint frame in the parent's
    JointGeometry shape;  // at the present poses
    std::vector<TreeNode>& nodes;

    TreeNode& add(TreeNode::Kind kind, std::size_t coordinate) {
        TreeNode node;
        node.kind = kind;
        node.coordinate = std::uint8_t(coordinate);
        node.sign = forward ? 1.0 : -1.0;
        node.armature = joint.armature(coordinate);
        nodes.push_back(node);
        return nodes.back();
    }

    // `entry`: joint frame to the frame that the rotations start in; returns whether they are all locked.
    bool add_turns(const Quat& entry, const Quat& exit) {
        int free = 0, last_free = 0, last_locked = 0;
        for (int i = 0; i < 3; ++i) {
            const bool locked = joint.locked(std::size_t(3 + i));
            (locked ? last_locked : last_free) = i;
            free += !locked;
        }
        if (free == 0) return true;
        if (free == 1) {
            const Vec3 axis = Vec3::Unit(last_free);
            const auto [c, s] = unit(relative.w(), relative.vec()[last_free]);
            TreeNode& node = add(NodeKind::revolute, std::size_t(3 + last_free));
            node.turned = (entry * about(axis, c, s) * exit.conjugate()).normalized();
            node.axis = exit * axis;
        }
        if (free == 2) add_universal(last_locked, entry, exit);
        if (free == 3) add(NodeKind::ball, 3).turned = (entry * relative * exit.conjugate()).normalized();
        return false;
    }

    // relative = (rotation about m) (rotation about n): with half angles c, s the components are
    // c_m c_n, s_m c_n, c_m s_n and, about m x n, s_m s_n.
    void add_universal(int locked, const Quat& entry, const Quat& exit) {
        int m = (locked + 1) % 3, n = (locked + 2) % 3;
        if (!forward) std::swap(m, n);
        const double w = relative.w(), x = relative.vec()[m], y = relative.vec()[n];
        const double z = forward ? relative.vec()[locked] : -relative.vec()[locked];
        const auto [cm, sm] = hypotenuse(w, x) >= hypotenuse(y, z) ? unit(w, x) : unit(y, z);
        const auto [cn, sn] = unit(w * cm + x * sm, y * cm + z * sm);
        TreeNode& first = add(NodeKind::revolute, std::size_t(3 + m));
        first.turned = (entry * about(Vec3::Unit(m), cm, sm)).normalized();
        first.axis = Vec3::Unit(m);
        TreeNode& second = add(NodeKind::revolute, std::size_t(3 + n));
        second.turned = (about(Vec3::Unit(n), cn, sn) * exit.conjugate()).normalized();
        second.axis = exit * Vec3::Unit(n);
    }

    // The displacements are along axes of the first body: the parent, or the child.
    void fill() {
        const Quat weld = (parent * child.conjugate()).normalized();
        std::vector<std::size_t> moves;
        for (std::size_t k = 0; k < 3; ++k)
            if (!joint.locked(k)) moves.push_back(k);
        bool welded = false;
        if (!forward || moves.empty()) welded = add_turns(parent, child);
        if (welded && moves.empty()) {
            add(NodeKind::fixed, 0).turned = weld;
            return;
        }
        Quat frame = parent;
        if (!forward && !welded) frame = child;  // behind the rotations
        for (const std::size_t k : moves) {
            TreeNode& node = add(NodeKind::prismatic, k);
            node.axis = frame * Vec3::Unit(int(k));
            node.arm = node.sign * shape.coordinates[k].value * node.axis;
            if (!forward && welded && k == moves.front()) {
                node.turned = weld;
                frame = child;
            }
        }
        if (forward && !moves.empty() && add_turns(parent, child)) nodes.back().turned = weld;
    }
};

double worst_error(const Joint& joint, const JointGeometry& shape) {
    double worst = 0.0;
    for (std::size_t k = 0; k < joint.count(); ++k)
        if (joint.locked(k)) worst = std::max(worst, std::abs(shape.coordinates[k].value) / (k < 3 ? joint.size : 1.0));
    return worst;
}

}  // namespace

int JointTree::place_of(const Joint* joint) const {
    const auto found = std::find(joints_.begin(), joints_.end(), joint);
    return found != joints_.end() ? int(found - joints_.begin()) : TreeNode::no_joint;
}

// From the roots on, breadth first. The heaviest body is the root of a free tree.
void JointTree::order_bodies(const std::vector<Body>& bodies, std::span<const std::uint32_t> island) {
    const std::size_t n = island.size(), m = spanning_.kept.size();
    first_.assign(n + 1, 0);
    next_.resize(2 * m);
    child_.assign(m, TreeNode::no_body);
    parent_.assign(m, TreeNode::no_body);
    order_.clear();
    hung_ = TreeNode::no_joint;
    for (std::size_t e = 0; e < 2 * m; ++e)
        if (spanning_.kept[e / 2] && spanning_.ends[e] != TreeNode::no_body)
            ++first_[std::size_t(spanning_.ends[e]) + 1];
    for (std::size_t k = 0; k < n; ++k) first_[k + 1] += first_[k];
    std::vector<int> filled(first_.begin(), first_.end() - 1);
    for (std::size_t e = 0; e < 2 * m; ++e)
        if (spanning_.kept[e / 2] && spanning_.ends[e] != TreeNode::no_body)
            next_[std::size_t(filled[std::size_t(spanning_.ends[e])]++)] = int(e);
    for (std::size_t k = 0; k < m; ++k) {
        if (!spanning_.kept[k] ||
            (spanning_.ends[2 * k] != TreeNode::no_body && spanning_.ends[2 * k + 1] != TreeNode::no_body))
            continue;
        if (hung_ == TreeNode::no_joint) hung_ = int(k);
        child_[k] = std::max(spanning_.ends[2 * k], spanning_.ends[2 * k + 1]);
        order_.push_back({child_[k], int(k)});
        grow(order_.size() - 1);
    }
    std::vector<char> reached(n, 0);
    while (order_.size() < n) {
        for (const Link& link : order_) reached[std::size_t(link.body)] = 1;
        int root = TreeNode::no_body;
        for (std::size_t k = 0; k < n; ++k)
            if (!reached[k] &&
                (root == TreeNode::no_body || bodies[island[k]].mass > bodies[island[std::size_t(root)]].mass))
                root = int(k);
        order_.push_back({root, TreeNode::no_joint});
        grow(order_.size() - 1);
    }
}

void JointTree::grow(std::size_t at) {
    for (; at < order_.size(); ++at) {
        const Link link = order_[at];
        for (int e = first_[std::size_t(link.body)]; e < first_[std::size_t(link.body) + 1]; ++e) {
            const int end = next_[std::size_t(e)], joint = end / 2, other = spanning_.ends[std::size_t(end ^ 1)];
            if (joint == link.joint) continue;
            child_[std::size_t(joint)] = other;
            parent_[std::size_t(joint)] = link.body;
            order_.push_back({other, joint});
        }
    }
}

// The two sides of a joint, as the tree sees them.
struct TreeSides {
    JointSide parent, child;
    Quat frame_parent, frame_child;
    Vec3 anchor_parent, anchor_child;

    TreeSides(const Joint& joint, const std::vector<Body>& bodies, bool forward) {
        parent = side_of(bodies, forward ? joint.a : joint.b);
        child = side_of(bodies, forward ? joint.b : joint.a);
        frame_parent = forward ? joint.frame_a : joint.frame_b;
        frame_child = forward ? joint.frame_b : joint.frame_a;
        anchor_parent = forward ? joint.anchor_a : joint.anchor_b;
        anchor_child = forward ? joint.anchor_b : joint.anchor_a;
    }
};

void JointTree::find_basis(Hang& hang, const Joint& joint) const {
    const Quat entry = hang.forward ? joint.frame_a : joint.frame_b;
    const Quat exit = (hang.forward ? joint.frame_b : joint.frame_a).conjugate();
    const TreeNode& node = nodes_[std::size_t(hang.first)];
    const int axis = node.kind == NodeKind::revolute ? node.coordinate - 3 : 0;
    hang.basis[0] = (entry * exit).normalized();
    for (int k = 0; k < 3; ++k) {
        const Vec3 e = Vec3::Unit((axis + k) % 3);
        hang.basis[k + 1] = (entry * Quat(0.0, e.x(), e.y(), e.z()) * exit).normalized();
    }
}

void JointTree::add_joint(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, Joint& joint,
                          const Link& link) {
    Hang& hang = hangs_[std::size_t(link.joint)];
    hang = {};
    hang.forward = spanning_.ends[2 * std::size_t(link.joint) + 1] == link.body;
    const int parent_body = parent_of(link.joint);
    if (parent_body == TreeNode::no_body && link.joint != hung_) {
        hang.anchor = int(nodes_.size());
        nodes_.emplace_back().joint = link.joint;
    }
    hang.first = int(nodes_.size());
    const TreeSides sides(joint, bodies, hang.forward);
    sequence_.clear();
    Sequence{joint, hang.forward, sides.frame_parent, sides.frame_child, Quat::Identity(), {}, sequence_}.fill();
    for (std::size_t k = 0; k < sequence_.size(); ++k) {
        TreeNode& node = nodes_.emplace_back(sequence_[k]);
        node.parent = k > 0                              ? int(nodes_.size()) - 2
                      : parent_body == TreeNode::no_body ? hang.anchor
                                                         : node_of_[std::size_t(parent_body)];
        node.joint = link.joint;
    }
    hang.count = int(sequence_.size());
    const NodeKind kind = nodes_.back().kind;
    hang.direct = hang.count == 1 && kind != NodeKind::prismatic;
    hang.plain = hang.count == 1 && (kind != NodeKind::ball || joint.turns_alike());
    if (hang.direct) find_basis(hang, joint);
    nodes_.back().center = -sides.anchor_child;
    set_body(nodes_.back(), link.body, bodies[island[std::size_t(link.body)]]);
    for (int side = 0; side < 2; ++side) {
        const int place = side == 0 ? link.body : parent_body;
        if (place == TreeNode::no_body) continue;
        const Body& body = bodies[island[std::size_t(place)]];
        const Vec3 arm = body.principal_axes.conjugate() * (side == 0 ? sides.anchor_child : sides.anchor_parent);
        const auto lever_about = [&](const Vec3& axis) {
            return axis.cross(arm).norm() * axis.dot(axis.cwiseQuotient(body.principal_inertia));
        };
        // In a loop a hinge and its neighbors turn about few axes.
        if (!spanning_.cut.empty() && hang.direct && kind != NodeKind::ball) {
            const Quat& frame = (side == 0) == hang.forward ? joint.frame_b : joint.frame_a;
            if (kind == NodeKind::revolute)
                hang.levers[side] =
                    lever_about(body.principal_axes.conjugate() * (frame * Vec3::Unit(nodes_.back().coordinate - 3)));
            continue;
        }
        for (int c = 0; c < 3; ++c) hang.levers[side] = std::max(hang.levers[side], lever_about(Vec3::Unit(c)));
    }
}

void JointTree::set_body(TreeNode& node, int place, const Body& body) {
    node.body = place;
    node.mass = body.mass;
    node.inertia = symmetric(body.inertia_body);
    node.aligned = node.inertia.xy == 0.0 && node.inertia.xz == 0.0 && node.inertia.yz == 0.0;
    node_of_[std::size_t(place)] = int(&node - nodes_.data());
}

bool JointTree::same(std::span<const std::uint32_t> island, std::span<Joint* const> joints) const {
    return std::equal(island.begin(), island.end(), island_.begin(), island_.end()) &&
           std::equal(joints.begin(), joints.end(), joints_.begin(), joints_.end()) &&
           std::none_of(joints.begin(), joints.end(), [](const Joint* joint) { return joint->broken; });
}

// All of the nodes but their arms and turns at the present poses.
void JointTree::build(const std::vector<Body>& bodies, std::span<const std::uint32_t> island,
                      std::span<Joint* const> joints) {
    nodes_.clear();
    nodes_.reserve(7 * island.size());
    node_of_.assign(island.size(), 0);
    hangs_.resize(joints.size());
    for (const Link& link : order_) {
        if (link.joint != TreeNode::no_joint) {
            add_joint(bodies, island, *joints[std::size_t(link.joint)], link);
            continue;
        }
        TreeNode& root = nodes_.emplace_back();
        root.kind = NodeKind::free;
        set_body(root, link.body, bodies[island[std::size_t(link.body)]]);
    }
    coordinates_ = speeds_ = 0;
    for (TreeNode& node : nodes_) {
        node.at = coordinates_;
        node.speed_at = speeds_;
        coordinates_ += node.coordinates();
        speeds_ += node.speeds();
    }
}

// A free tree: from the center of mass.
void JointTree::find_origin(const std::vector<Body>& bodies, std::span<const std::uint32_t> island,
                            std::span<Joint* const> joints) {
    const Vec3 near = bodies[island[0]].position;
    origin_ = near;
    ground_ = Quat::Identity();
    carrier_ = Joint::world;
    if (spanning_.free) {
        double mass = 0.0;
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t i : island) {
            mass += bodies[i].mass;
            sum += bodies[i].mass * (bodies[i].position - near);
        }
        origin_ = near + sum / mass;
    } else if (hung_ != TreeNode::no_joint) {
        const Joint& joint = *joints[std::size_t(hung_)];
        const bool forward = hangs_[std::size_t(hung_)].forward;
        const JointSide side = side_of(bodies, forward ? joint.a : joint.b);
        ground_ = side.orientation;
        carried_at_ = forward ? joint.anchor_a : joint.anchor_b;
        origin_ = side.position + side.orientation * carried_at_;
        if (const std::uint32_t body = forward ? joint.a : joint.b; body != Joint::world && bodies[body].track)
            carrier_ = body;
    }
}

// The part of the ground that a further joint hangs on.
void JointTree::load_anchor(const std::vector<Body>& bodies, const Joint& joint, const Hang& hang) {
    if (hang.anchor == TreeNode::ground) return;
    const JointSide side = side_of(bodies, hang.forward ? joint.a : joint.b);
    TreeNode& node = nodes_[std::size_t(hang.anchor)];
    node.arm = ground_.conjugate() *
               (side.position + side.orientation * (hang.forward ? joint.anchor_a : joint.anchor_b) - origin_);
    node.turned = (ground_.conjugate() * side.orientation).normalized();
}

// A joint without displacements that is a single node.
void JointTree::load_direct(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, const Joint& joint,
                            const Link& link) {
    const Hang& hang = hangs_[std::size_t(link.joint)];
    TreeNode& node = nodes_[std::size_t(hang.first)];
    const Body& child = bodies[island[std::size_t(link.body)]];
    const Vec3& anchor_parent = hang.forward ? joint.anchor_a : joint.anchor_b;
    const Vec3& anchor_child = hang.forward ? joint.anchor_b : joint.anchor_a;
    Vec3 apart = child.position + child.rotation * anchor_child;
    Quat relative;
    if (const int above = parent_of(link.joint); above != TreeNode::no_body) {
        const Body& parent = bodies[island[std::size_t(above)]];
        apart -= parent.position + parent.rotation * anchor_parent;
        node.arm = nodes_[std::size_t(node.parent)].center + anchor_parent;
        relative = parent.orientation.conjugate() * child.orientation;
    } else {
        const JointSide side = side_of(bodies, hang.forward ? joint.a : joint.b);
        apart -= side.position + side.orientation * anchor_parent;
        relative = side.orientation.conjugate() * child.orientation;
    }
    double worst = apart.norm() / joint.size;
    if (node.kind == NodeKind::ball) {
        node.turned = relative.normalized();
    } else {
        const bool turns = node.kind == NodeKind::revolute;
        double part[4];
        for (int k = 0; k < 4; ++k) part[k] = hang.basis[k].coeffs().dot(relative.coeffs());
        if (!turns) worst = std::max(worst, 2.0 * std::abs(part[1]));
        worst = std::max({worst, 2.0 * std::abs(part[2]), 2.0 * std::abs(part[3])});
        node.turned = hang.basis[0];
        if (turns) {
            const double length = std::sqrt(part[0] * part[0] + part[1] * part[1]);
            node.turned.coeffs() =
                part[0] / length * hang.basis[0].coeffs() + part[1] / length * hang.basis[1].coeffs();
        }
    }
    gap_ = std::max(gap_, worst);
}

void JointTree::linearize_joint(const std::vector<Body>& bodies, const Joint& joint, const Link& link) {
    const Hang& hang = hangs_[std::size_t(link.joint)];
    const TreeSides sides(joint, bodies, hang.forward);
    TreeNode& first = nodes_[std::size_t(hang.first)];
    Vec3 arm = Vec3::Zero();
    if (parent_of(link.joint) != TreeNode::no_body)
        arm = nodes_[std::size_t(first.parent)].center + sides.anchor_parent;
    const JointSide &a = hang.forward ? sides.parent : sides.child, &b = hang.forward ? sides.child : sides.parent;
    const JointGeometry shape = measure(joint, a, b);
    gap_ = std::max(gap_, worst_error(joint, shape));
    const Quat relative =
        ((sides.parent.orientation * sides.frame_parent).conjugate() * (sides.child.orientation * sides.frame_child))
            .normalized();
    sequence_.clear();
    Sequence{joint, hang.forward, sides.frame_parent, sides.frame_child, relative, shape, sequence_}.fill();
    for (std::size_t k = 0; k < sequence_.size(); ++k) {
        TreeNode& node = nodes_[std::size_t(hang.first) + k];
        node.arm = sequence_[k].arm;
        node.turned = sequence_[k].turned;
        node.axis = sequence_[k].axis;
    }
    first.arm += arm;
}

bool JointTree::find(const std::vector<Body>& bodies, std::span<const std::uint32_t> island,
                     std::span<Joint* const> joints, std::span<const Joint> all) {
    if (!same(island, joints)) {
        island_.assign(island.begin(), island.end());
        joints_.assign(joints.begin(), joints.end());
        is_tree_ = span_joints(island, joints, all, spanning_) && spanning_.rows <= tuning::tree_most_closures;
        if (is_tree_) {
            order_bodies(bodies, island);
            build(bodies, island, joints);
        }
    }
    if (!is_tree_) return false;
    gap_ = 0.0;
    find_origin(bodies, island, joints);
    for (const Link& link : order_) {
        if (link.joint == TreeNode::no_joint) {
            TreeNode& root = nodes_[std::size_t(node_of_[std::size_t(link.body)])];
            const Body& body = bodies[island[std::size_t(link.body)]];
            root.arm = body.position - origin_;
            root.turned = body.orientation;
            continue;
        }
        const Joint& joint = *joints[std::size_t(link.joint)];
        const Hang& hang = hangs_[std::size_t(link.joint)];
        load_anchor(bodies, joint, hang);
        if (hang.direct)
            load_direct(bodies, island, joint, link);
        else
            linearize_joint(bodies, joint, link);
    }
    return true;
}

void JointTree::start(double* coordinates) const {
    for (const TreeNode& node : nodes_) {
        double* q = coordinates + node.at;
        if (node.kind == NodeKind::revolute || node.kind == NodeKind::prismatic) q[0] = 0.0;
        if (node.kind == NodeKind::free) {
            for (int i = 0; i < 3; ++i) *q++ = node.arm[i];
        }
        if (node.kind == NodeKind::ball || node.kind == NodeKind::free)
            for (int i = 0; i < 4; ++i) q[i] = node.turned.coeffs()[i];
    }
}

}  // namespace tumble
