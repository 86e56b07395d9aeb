// Accelerations of a tree of joined bodies by the articulated-body algorithm (Featherstone 1983; 2008, Table 7.1), in a
// time proportional to the number of its nodes. Spatial vectors are about the joint of each node, in world axes.
#pragma once

#include "sim/articulation/joint_tree.h"
#include "sim/articulation/spatial.h"
#include "sim/math/wrench.h"

#include <span>
#include <vector>

namespace tumble {

class ForwardDynamics {
public:
    /// A node in motion; positions are relative to the tree's origin.
    struct Link {
        Quat orientation = Quat::Identity();
        Mat3 rotation = Mat3::Identity();
        Vec3 point = Vec3::Zero();   // m, of the joint
        Vec3 arm = Vec3::Zero();     // m, from the parent's point
        Vec3 center = Vec3::Zero();  // m, from the point to the center of mass
        Vec3 axis = Vec3::Zero();    // of a revolute or prismatic node
        SpatialMotion velocity, acceleration;

        Vec3 position() const { return point + center; }
        Vec3 center_velocity() const { return velocity.move + velocity.turn.cross(center); }

    private:
        friend class ForwardDynamics;
        // NOLINTBEGIN(readability-identifier-naming): members of a struct for its friend
        SpatialMotion bias;         // c: of the acceleration, by the velocities
        Sym3 turning;               // kg m^2, of the body about its joint
        SpatialInertia inertia;     // I^A; then I^a, which its joint passes on; of a held ball I^A
        SpatialForce effort;        // p^A; then p^a
        SpatialForce column;        // U = I^A S; of a ball: u
        double pivot = 0.0;         // 1 / D, D = S^T U + added
        double added = 0.0;         // to D: infinite where its coordinate does not accelerate
        double drive = 0.0;         // u = tau - S^T p^A
        Sym3 inverse;               // of a ball: D^-1; C where it is held
        Vec3 twist = Vec3::Zero();  // of a ball: N m, of the parent
        Vec3 about = Vec3::Zero();  // of a ball: the axis n about which it is held
        double wanted = 0.0;        // of a ball: n . its acceleration
        Vec3 given = Vec3::Zero();  // of a ball: acceleration that this takes
        // NOLINTEND(readability-identifier-naming)
    };

    explicit ForwardDynamics(const JointTree& tree) : tree_(tree) {}

    /// The ground moves: its pose (position from the tree's origin), velocity and acceleration, from the next call on.
    void carry(const Quat& orientation, const Vec3& point, const SpatialMotion& velocity,
               const SpatialMotion& acceleration);
    /// The ground stands still, at the tree's origin.
    void stand() { carried_ = false; }
    /// Places, velocities and inertias of all nodes. Quaternions may have any length. Speeds of a ball are components
    /// in the parent's frame.
    void move(const double* coordinates, const double* speeds);
    /// The same without inertias: for positions and velocities alone.
    void place(const double* coordinates, const double* speeds);
    /// Other speeds at the positions of the last move().
    void set_speeds(const double* speeds);
    /// A force on a node's body, and a torque (N m) or force (N) along the coordinate of a revolute or prismatic node;
    /// between move() or set_speeds() and accelerate() or respond().
    void apply(int node, const Wrench& wrench);
    void drive(int node, double effort) { links_[std::size_t(node)].drive += effort; }
    /// A torque (N m) of the parent on a ball node, between the same; components in the parent's frame.
    void twist(int node, const Vec3& torque) { links_[std::size_t(node)].twist += frame_of(node) * torque; }
    /// Between move() and accelerate(): the coordinate of a revolute or prismatic node does not accelerate; or has a
    /// further inertia (kg m^2, kg), as that of an implicit damper.
    void hold(int node) { links_[std::size_t(node)].added = infinity; }
    void add_inertia(int node, double amount) { links_[std::size_t(node)].added += amount; }
    /// Between the same: n . (rates of a ball's speeds) is as given; n has components in the parent's frame. Not for
    /// respond() and joint_force().
    void hold_about(int node, const Vec3& n, double acceleration) {
        links_[std::size_t(node)].about = frame_of(node) * n;
        links_[std::size_t(node)].wanted = acceleration;
    }
    /// Torque (N m) in units of n that holds the ball, after accelerate().
    double holding_torque(int node) const {
        const Link& held = links_[std::size_t(node)];
        const Vec3 sum = held.inertia.turning * held.acceleration.turn + held.inertia.mixed * held.acceleration.move;
        return held.about.dot(sum - held.column.moment) / held.about.squaredNorm();
    }
    /// Effort (N m, N) that accelerates the coordinate of a held node if it is let go, after accelerate().
    double net_effort(int node) const {
        const Link& held = links_[std::size_t(node)];
        return held.drive - held.column.moment.dot(held.acceleration.turn) -
               held.column.force.dot(held.acceleration.move);
    }
    /// Rates of the speeds. `base`: acceleration of the ground, which acts as gravity of -base; not of free trees.
    void accelerate(const Vec3& base, double* rates);
    /// The same with the inertias of the last accelerate(): for other efforts and speeds at the same positions.
    void respond(const Vec3& base, double* rates);
    /// Before accelerate(): keeps the efforts, for a second solve with further ones.
    void keep_efforts();
    void restore_efforts();
    /// After accelerate(): `efforts` along all speeds alone act at rest; give_back() ends that. Columns of M^-1.
    void set_aside();
    void respond_to(const double* efforts, double* rates);
    void give_back() {
        links_.swap(aside_);
        ground_.acceleration = ground_aside_;
    }
    /// Rates of the coordinates, after move().
    void coordinate_rates(const double* coordinates, const double* speeds, double* rates) const;

    /// The positions of all nodes by the present poses of the bodies, for find_speeds().
    void set_state(const std::vector<Body>& bodies, std::span<const std::uint32_t> island, const double* coordinates);
    /// Speeds of the tree at given velocities of its bodies (of the center of mass), after set_state() or move(); and
    /// its velocities at those speeds. They are the given ones if these fit the joints.
    void find_speeds(std::span<const SpatialMotion> bodies, double* speeds);

    /// Force and moment (about the node's point) that the joint of a node gives to the rest of the tree behind it,
    /// after accelerate() or respond(): I^a a + p^a, with the acceleration of the parent. Not of a free root.
    SpatialForce joint_force(int node) const;

    /// Force and moment (about the node's point) that the joint of each node gives to the rest of the tree behind it:
    /// by the recursive Newton-Euler algorithm (Featherstone 2008, Table 5.1), after accelerate().
    void joint_forces(std::span<const Wrench> wrenches, std::vector<SpatialForce>& forces) const;

    const Link& link(int node) const { return node == TreeNode::ground ? ground_ : links_[std::size_t(node)]; }

private:
    void start();
    void place_node(const TreeNode& node, Link& link, const double* q) const;
    void speed_node(const TreeNode& node, Link& link, const double* speed) const;
    static void load_inertia(const TreeNode& node, Link& link);
    static void load_effort(const TreeNode& node, Link& link);
    const Link& above(const TreeNode& node) const {
        return node.parent == TreeNode::ground ? ground_ : links_[std::size_t(node.parent)];
    }
    const Mat3& frame_of(int node) const { return above(tree_.nodes()[std::size_t(node)]).rotation; }
    static SpatialForce pass_on_ball(Link& link, SpatialInertia& passed);
    template <bool factor>
    void sweep_in();
    void sweep_out(const Vec3& base, double* rates);

    const JointTree& tree_;
    struct Efforts {
        SpatialForce effort;
        double drive = 0.0;
        Vec3 twist = Vec3::Zero();
    };
    std::vector<Link> links_, aside_;
    std::vector<Efforts> efforts_;
    SpatialMotion ground_aside_;
    Link ground_;
    bool carried_ = false;
    SpatialMotion carrying_;  // acceleration of the ground
};

}  // namespace tumble
