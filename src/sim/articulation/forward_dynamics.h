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
    /// A node in motion; places are relative to the tree's origin.
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
        SpatialMotion bias;           // c: of the acceleration, by the velocities
        SpatialInertia inertia;       // I^A
        SpatialForce effort;          // p^A
        SpatialForce column;          // U = I^A S
        double pivot = 0.0;           // 1 / (S^T U)
        double drive = 0.0;           // u = tau - S^T p^A
        bool held = false;            // its coordinate does not accelerate
        Sym3 inverse;                 // of a ball: D^-1
        Vec3 turning = Vec3::Zero();  // of a ball: u
    };

    explicit ForwardDynamics(const JointTree& tree) : tree_(tree) {}

    /// Places, velocities and inertias of all nodes. Quaternions may have any length.
    void move(const double* coordinates, const double* speeds);
    /// A force on a node's body, and a torque (N m) or force (N) along the coordinate of a revolute or prismatic node;
    /// between move() and accelerate().
    void push(int node, const Wrench& wrench);
    void drive(int node, double effort) { links_[std::size_t(node)].drive += effort; }
    /// Between the same: the coordinate of a revolute or prismatic node does not accelerate.
    void hold(int node) { links_[std::size_t(node)].held = true; }
    /// Effort (N m, N) that accelerates the coordinate of a held node if it is let go, after accelerate().
    double net_effort(int node) const {
        const Link& held = links_[std::size_t(node)];
        return held.drive - held.column.moment.dot(held.acceleration.turn) -
               held.column.force.dot(held.acceleration.move);
    }
    /// Rates of the speeds. `base`: acceleration of the ground, which acts as gravity of -base; not of free trees.
    void accelerate(const Vec3& base, double* rates);
    /// Rates of the coordinates, after move().
    void coordinate_rates(const double* coordinates, const double* speeds, double* rates) const;

    /// Speeds of the tree at given velocities of its bodies (of the center of mass), after move() with speeds of 0; and its
    /// velocities at those speeds. They are the given ones if these fit the joints.
    void find_speeds(std::span<const SpatialMotion> bodies, double* speeds);

    /// Force and moment (about the node's point) that the joint of each node gives to the rest of the tree behind it: by
    /// the recursive Newton-Euler algorithm (Featherstone 2008, Table 5.1), after accelerate().
    void joint_forces(std::span<const Wrench> pushes, std::vector<SpatialForce>& forces) const;

    const Link& link(int node) const { return links_[std::size_t(node)]; }

private:
    void move_node(const TreeNode& node, Link& link, const double* q, const double* speed) const;
    void add_body(const TreeNode& node, Link& link) const;
    const Link& above(const TreeNode& node) const {
        return node.parent == TreeNode::ground ? ground_ : links_[std::size_t(node.parent)];
    }
    void sweep_in();
    void sweep_out(const Vec3& base, double* rates);

    const JointTree& tree_;
    std::vector<Link> links_;
    Link ground_;
};

}  // namespace tumble
