#include "sim/articulation/joint_tree.h"

#include "core/deterministic_math.h"

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

/// One side of a joint as its node sees it.
struct Side {
    Quat frame;   // joint frame to the node's frame
    Vec3 anchor;  // m, from the node's center of mass, in its frame
};

/// The coordinates of a joint from the parent to the child, as primitive joints.
struct Sequence {
    const Joint& joint;
    bool forward;  // the parent is the joint's first body
    Side parent, child;
    Quat relative;        // of the child's joint frame in the parent's
    JointGeometry shape;  // at the present poses
    std::vector<TreeNode>& nodes;

    TreeNode& add(TreeNode::Kind kind, std::size_t coordinate) {
        TreeNode node;
        node.kind = kind;
        node.coordinate = std::uint8_t(coordinate);
        node.sign = forward ? 1.0 : -1.0;
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
        const Quat weld = (parent.frame * child.frame.conjugate()).normalized();
        std::vector<std::size_t> moves;
        for (std::size_t k = 0; k < 3; ++k)
            if (!joint.locked(k)) moves.push_back(k);
        bool welded = false;
        if (!forward || moves.empty()) welded = add_turns(parent.frame, child.frame);
        if (welded && moves.empty()) {
            add(NodeKind::fixed, 0).turned = weld;
            return;
        }
        Quat frame = parent.frame;
        if (!forward && !welded) frame = child.frame;  // behind the rotations
        for (const std::size_t k : moves) {
            TreeNode& node = add(NodeKind::prismatic, k);
            node.axis = frame * Vec3::Unit(int(k));
            node.arm = node.sign * shape.coordinates[k].value * node.axis;
            if (!forward && welded && k == moves.front()) {
                node.turned = weld;
                frame = child.frame;
            }
        }
        if (forward && !moves.empty() && add_turns(parent.frame, child.frame)) nodes.back().turned = weld;
    }
};

double worst_error(const Joint& joint, const JointGeometry& shape) {
    double worst = 0.0;
    for (std::size_t k = 0; k < joint.count(); ++k)
        if (joint.locked(k)) worst = std::max(worst, std::abs(shape.coordinates[k].value) / (k < 3 ? joint.size : 1.0));
    return worst;
}

int place_in(std::span<const std::uint32_t> island, std::uint32_t body) {
    const auto found = std::lower_bound(island.begin(), island.end(), body);
    return found != island.end() && *found == body ? int(found - island.begin()) : TreeNode::no_body;
}

}  // namespace

// From the root on, breadth first. The heaviest body is the root of a free tree.
bool JointTree::order_bodies(const std::vector<Body>& bodies, std::span<const std::uint32_t> island,
                             std::span<Joint* const> joints) {
    const std::size_t n = island.size(), m = joints.size();
    first_.assign(n + 1, 0);
    next_.resize(2 * m);
    ends_.resize(2 * m);
    child_.assign(m, TreeNode::no_body);
    parent_.assign(m, TreeNode::no_body);
    order_.clear();
    int hung = TreeNode::no_joint;
    for (std::size_t k = 0; k < m; ++k) {
        const Joint& joint = *joints[k];
        if (joint.broken || joint.distance()) return false;
        ends_[2 * k] = joint.a == Joint::world ? TreeNode::no_body : place_in(island, joint.a);
        ends_[2 * k + 1] = joint.b == Joint::world ? TreeNode::no_body : place_in(island, joint.b);
        for (const int end : {ends_[2 * k], ends_[2 * k + 1]}) {
            if (end != TreeNode::no_body) {
                ++first_[std::size_t(end) + 1];
            } else {
                if (hung != TreeNode::no_joint) return false;
                hung = int(k);
            }
        }
    }
    if (m + 1 != n + (hung != TreeNode::no_joint)) return false;
    for (std::size_t k = 0; k < n; ++k) first_[k + 1] += first_[k];
    std::vector<int> filled(first_.begin(), first_.end() - 1);
    for (std::size_t e = 0; e < 2 * m; ++e)
        if (ends_[e] != TreeNode::no_body) next_[std::size_t(filled[std::size_t(ends_[e])]++)] = int(e);
    Link root{0, hung};
    if (hung != TreeNode::no_joint) {
        const std::size_t k = std::size_t(hung);
        root.body = std::max(ends_[2 * k], ends_[2 * k + 1]);
        child_[k] = root.body;
    } else {
        for (std::size_t k = 1; k < n; ++k)
            if (bodies[island[k]].mass > bodies[island[std::size_t(root.body)]].mass) root.body = int(k);
    }
    order_.push_back(root);
    for (std::size_t at = 0; at < order_.size(); ++at) {
        const Link link = order_[at];
        for (int e = first_[std::size_t(link.body)]; e < first_[std::size_t(link.body) + 1]; ++e) {
            const int end = next_[std::size_t(e)], joint = end / 2, other = ends_[std::size_t(end ^ 1)];
            if (joint == link.joint) continue;
            if (order_.size() == n) return false;  // a loop
            child_[std::size_t(joint)] = other;
            parent_[std::size_t(joint)] = link.body;
            order_.push_back({other, joint});
        }
    }
    return order_.size() == n;
}

void JointTree::add_joint(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, Joint& joint,
                          const Link& link) {
    const bool forward = ends_[2 * std::size_t(link.joint) + 1] == link.body;
    const auto pose = [&](std::uint32_t i) -> JointSide {
        if (i == Joint::world) return {};
        return {bodies[i].position, bodies[i].orientation};
    };
    const JointSide a = pose(joint.a), b = pose(joint.b);
    const JointGeometry shape = measure(joint, a, b);
    gap_ = std::max(gap_, worst_error(joint, shape));
    Quat frame_p = joint.frame_a, frame_c = joint.frame_b;
    Vec3 anchor_p = joint.anchor_a, anchor_c = joint.anchor_b;
    JointSide side_p = a, side_c = b;
    if (!forward) {
        std::swap(frame_p, frame_c);
        std::swap(anchor_p, anchor_c);
        std::swap(side_p, side_c);
    }
    const Body& body = bodies[island[std::size_t(link.body)]];
    const int parent_body = parent_of(link.joint);
    const Quat to_child = body.principal_axes.conjugate();
    const Side child{to_child * frame_c, to_child * anchor_c};
    Side parent{frame_p, anchor_p};
    int parent_node = TreeNode::ground;
    Vec3 arm = Vec3::Zero();
    if (parent_body == TreeNode::no_body) {
        ground_ = side_p.orientation;
        origin_ = side_p.position + side_p.orientation * anchor_p;
    } else {
        parent_node = node_of_[std::size_t(parent_body)];
        const TreeNode& above = nodes_[std::size_t(parent_node)];
        const Quat to_parent = above.principal.conjugate();
        parent = {to_parent * frame_p, to_parent * anchor_p};
        arm = above.center + parent.anchor;
    }
    const std::size_t begin = nodes_.size();
    const Quat relative = ((side_p.orientation * frame_p).conjugate() * (side_c.orientation * frame_c)).normalized();
    Sequence{joint, forward, parent, child, relative, shape, nodes_}.fill();
    nodes_[begin].arm += arm;
    for (std::size_t k = begin; k < nodes_.size(); ++k) {
        TreeNode& node = nodes_[k];
        node.parent = k == begin ? parent_node : int(k) - 1;
        node.joint = link.joint;
    }
    TreeNode& last = nodes_.back();
    last.center = -child.anchor;
    set_body(last, link.body, body);
}

void JointTree::set_body(TreeNode& node, int place, const Body& body) {
    node.body = place;
    node.mass = body.mass;
    node.inertia = body.principal_inertia;
    node.principal = body.principal_axes;
    node_of_[std::size_t(place)] = int(nodes_.size()) - 1;
}

bool JointTree::find(const std::vector<Body>& bodies, std::span<const std::uint32_t> island,
                     std::span<Joint* const> joints) {
    if (!order_bodies(bodies, island, joints)) return false;
    nodes_.clear();
    node_of_.assign(island.size(), 0);
    gap_ = 0.0;
    for (const Link& link : order_) {
        if (link.joint != TreeNode::no_joint) {
            add_joint(bodies, island, *joints[std::size_t(link.joint)], link);
            continue;
        }
        double mass = 0.0;
        Vec3 sum = Vec3::Zero();
        const Vec3 near = bodies[island[0]].position;
        for (const std::uint32_t i : island) {
            mass += bodies[i].mass;
            sum += bodies[i].mass * (bodies[i].position - near);
        }
        origin_ = near + sum / mass;
        ground_ = Quat::Identity();
        const Body& body = bodies[island[std::size_t(link.body)]];
        TreeNode& root = nodes_.emplace_back();
        root.kind = NodeKind::free;
        root.arm = body.position - origin_;
        root.turned = (body.orientation * body.principal_axes).normalized();
        set_body(root, link.body, body);
    }
    coordinates_ = speeds_ = 0;
    for (TreeNode& node : nodes_) {
        node.at = coordinates_;
        node.speed_at = speeds_;
        coordinates_ += node.coordinates();
        speeds_ += node.speeds();
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
