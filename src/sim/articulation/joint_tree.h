// A spanning tree of an island of joined bodies, found from its joints, as a list of nodes from the roots to the
// leaves. Joints that would close a loop are cut; so are distance joints and gears. Each tree hangs on the ground or
// has a free root.
//
// A node is a body, or a massless part between two coordinates of one joint, and moves relative to its parent by one
// primitive joint: a universal joint is two revolute ones, a planar joint two prismatic ones and a revolute one.
// Coordinates are 0 at the start of a step; those of balls and of a free root are quaternions.
#pragma once

#include "core/vector.h"
#include "sim/articulation/spatial.h"
#include "sim/dynamics/body.h"
#include "sim/joints/spanning_joints.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct TreeNode {
    enum class Kind : std::uint8_t { fixed, revolute, prismatic, ball, free };
    static constexpr int ground = -1, no_body = -1, no_joint = -1;

    Kind kind = Kind::fixed;
    int parent = ground;
    int body = no_body;           // index among the island's bodies
    int joint = no_joint;         // index among the island's joints; of a free root: none
    std::uint8_t coordinate = 0;  // of the joint, 0 to 5: of revolute and prismatic nodes
    double sign = 1.0;            // of the joint's coordinate along the node's own
    int at = 0, speed_at = 0;     // first of its coordinates and of its speeds
    // In the parent's frame. A frame is that of the body, but its reference point is the joint's anchor.
    Vec3 arm = Vec3::Zero();         // m, from the parent's reference to this one's, at a coordinate of 0
    Quat turned = Quat::Identity();  // orientation at a coordinate of 0
    Vec3 axis = Vec3::Zero();        // prismatic: in the parent's frame; revolute: in the node's own
    // Mass properties of the body.
    double mass = 0.0;           // kg
    Sym3 inertia;                // kg m^2, about the center of mass
    bool aligned = false;        // the inertia has its principal axes along the frame
    Vec3 center = Vec3::Zero();  // m, from the reference to the center of mass
    double armature = 0.0;       // kg m^2 or kg, of the joint's coordinate

    /// Inertia in world axes, of a frame that r rotates into them.
    Sym3 inertia_at(const Mat3& r) const {
        if (!aligned) return inertia.turned(r);
        Sym3 sum;
        sum.add_outer(inertia.xx, r.col(0));
        sum.add_outer(inertia.yy, r.col(1));
        sum.add_outer(inertia.zz, r.col(2));
        return sum;
    }
    int coordinates() const {
        constexpr int counts[] = {0, 1, 1, 4, 7};
        return counts[int(kind)];
    }
    int speeds() const {
        constexpr int counts[] = {0, 1, 1, 3, 6};
        return counts[int(kind)];
    }
    /// True if speed k is in m/s, false if it is in rad/s.
    bool is_length(int k) const { return kind == Kind::prismatic || (kind == Kind::free && k >= 3); }
};

using NodeKind = TreeNode::Kind;

class JointTree {
public:
    /// Returns true if the joints connect these bodies (indices, ascending), no joint with laws closes a loop, and the
    /// others close few.
    /// Then nodes() belong to the present poses. The structure is kept from call to call while bodies and joints stay
    /// the same. `all`: the joints that gears refer to.
    bool find(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, std::span<Joint* const> joints,
              std::span<const Joint> all = {});

    bool found() const { return is_tree_; }
    const std::vector<TreeNode>& nodes() const { return nodes_; }
    /// True if no joint holds the island to the ground.
    bool is_free() const { return spanning_.free; }
    /// Joints (indices among the island's) that are cut.
    std::span<const int> cut() const { return spanning_.cut; }
    bool hangs(int joint) const { return child_[std::size_t(joint)] != TreeNode::no_body; }
    /// Index among the island's joints.
    int place_of(const Joint* joint) const;
    /// Node at the anchor of a joint to the ground, or TreeNode::ground at the origin.
    int anchor_node(int joint) const { return hangs_[std::size_t(joint)].anchor; }
    /// Single node of a joint that hangs.
    int node_of(int joint) const { return hangs_[std::size_t(joint)].first; }
    /// Node of each body of the island.
    std::span<const int> node_of_body() const { return node_of_; }
    /// Body at the side of the joint (index among the island's joints) that is farther from the root.
    int child_of(int joint) const { return child_[std::size_t(joint)]; }
    /// Body of the parent (index among the island's), by joint; no_body: the ground.
    int parent_of(int joint) const { return parent_[std::size_t(joint)]; }
    /// Bodies of the island from the root to the leaves, and the joint that each of them hangs on.
    struct Link {
        int body, joint;
    };
    std::span<const Link> order() const { return order_; }
    /// Compliance against turns about the principal axes of a joint's child (0) or parent (1), times the lever of a
    /// force across each: the largest, 1/(kg m).
    double lever_of(int joint, int side) const { return hangs_[std::size_t(joint)].levers[std::size_t(side)]; }
    /// True if the joint is a single node.
    bool plain(int joint) const { return hangs_[std::size_t(joint)].plain; }

    /// Where the first root hangs: the side of its joint that does not move, or the center of mass of a free tree.
    const Vec3& origin() const { return origin_; }
    const Quat& ground() const { return ground_; }
    /// The body with a prescribed motion that the root hangs on (index in the world), and the anchor in its frame, m,
    /// from the center of mass; Joint::world: the ground stands still.
    std::uint32_t carrier() const { return carrier_; }
    const Vec3& carried_at() const { return carried_at_; }
    /// The joint that the root hangs on; no_joint: a free tree.
    int hung() const { return hung_; }

    int coordinates() const { return coordinates_; }
    int speeds() const { return speeds_; }
    /// Coordinates at the start of the step: 0, quaternions, and the position of a free root relative to the origin.
    void start(double* coordinates) const;
    /// Largest distance of the bodies' present positions from those of the coordinates, in sizes of their joint, as
    /// found.
    double gap() const { return gap_; }

private:
    void order_bodies(const std::vector<Body>& bodies, std::span<const std::uint32_t> island);
    void grow(std::size_t at);
    struct Hang {  // the joint that a body hangs on; NOLINT: clang-tidy 14 names the copy of an array __i0
        int first = 0, count = 0;  // its nodes
        int anchor = TreeNode::ground;
        bool forward = true;  // the parent is the joint's first body
        bool direct = false;  // one node that locks all displacements
        bool plain = false;
        double levers[2] = {0.0, 0.0};
        // Four unit quaternions, square to each other. A fixed joint allows the first as the child's orientation in the
        // parent's frame; a hinge allows combinations of the first two.
        Quat basis[4];
    };
    bool same(std::span<const std::uint32_t> island, std::span<Joint* const> joints) const;
    void build(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, std::span<Joint* const> joints);
    void add_joint(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, Joint& joint,
                   const Link& link);
    void find_basis(Hang& hang, const Joint& joint) const;
    void find_origin(const std::vector<Body>& bodies, std::span<const std::uint32_t> island,
                     std::span<Joint* const> joints);
    void load_anchor(const std::vector<Body>& bodies, const Joint& joint, const Hang& hang);
    void load_direct(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, const Joint& joint,
                     const Link& link);
    void linearize_joint(const std::vector<Body>& bodies, const Joint& joint, const Link& link);
    void set_body(TreeNode& node, int place, const Body& body);

    std::vector<TreeNode> nodes_, sequence_;
    std::vector<Link> order_;
    std::vector<Hang> hangs_;  // by joint
    std::vector<std::uint32_t> island_;
    std::vector<Joint*> joints_;
    bool is_tree_ = false;
    SpanningJoints spanning_;
    int hung_ = TreeNode::no_joint;  // first joint to the ground that hangs
    std::vector<int> node_of_, child_, parent_, first_, next_;
    Vec3 origin_ = Vec3::Zero();
    Quat ground_ = Quat::Identity();
    std::uint32_t carrier_ = Joint::world;
    Vec3 carried_at_ = Vec3::Zero();
    double gap_ = 0.0;
    int coordinates_ = 0, speeds_ = 0;
};

}  // namespace tumble
