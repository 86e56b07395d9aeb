// The equations of an island's locks where the joints form a tree: the impulses f that change J u as asked,
//   M du = J^T f,   J du = asked,
// without a compliance, at a cost linear in the joints. From the leaves to the root each subtree is replaced by its inertia
// about its joint, less what the free directions of the joint do not pass on (articulated-body inertia, Featherstone 2008,
// section 7.1; the same elimination in maximal coordinates: Baraff 1996). The numbers stay of the order of masses, so the
// result is exact to rounding at any length of a chain.
#pragma once

#include "sim/articulation/spatial.h"
#include "sim/contact/direct/flight_locks.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class LockTree {
public:
    static constexpr std::uint32_t none = UINT32_MAX;
    /// A body, with the joint to its parent if it has one.
    struct Place {
        std::uint32_t body = none, joint = none;
    };

    /// The order of elimination. Precondition: locks.tree().
    void analyze(FlightLocks& locks);
    std::size_t size() const { return nodes_.size(); }
    /// Parents come before their children.
    Place place(std::size_t i) const { return {nodes_[i].body, nodes_[i].joint}; }
    /// Takes body i and its joint at their present poses, after FlightLocks::look() of it. Precondition: its parent has been
    /// taken before.
    void take(FlightLocks& locks, std::size_t i);
    /// Gives the bodies the impulses that change J u as asked. Returns false if one is not finite, or a pivot is not
    /// positive. Precondition: all bodies have been taken.
    bool solve(FlightLocks& locks);
    /// du of the last solve(): six numbers per body, velocities and the island's length times angular velocities.
    void changes(FlightLocks& locks, std::vector<double>& du) const;

private:
    /// A direction in which a joint lets its body move against its parent, or in which a root moves.
    struct Free {
        Vec3 direction = Vec3::Zero();  // world, unit vector
        bool turns = false;
        SpatialForce inertia;  // I s, of the subtree without the directions before this one
        double pivot = 0.0;    // 1 / (s . I s)
        double effort = 0.0;   // N s or N m s: impulse along it
    };
    /// A body, with the joint to its parent. The reference point is that of the joint; of a root without a joint, its
    /// center of mass.
    struct Node {
        std::uint32_t body = none, joint = none, parent = none;
        std::uint32_t first = 0, count = 0;  // of its free directions
        double side = 1.0;                   // 1: the body is B of the joint; -1: it is A
        Vec3 lever = Vec3::Zero();           // m, from the reference of the parent
        SpatialInertia inertia;              // of the subtree
        SpatialForce push;                   // N s, N m s: of the joints below
        SpatialMotion asked, change;         // m/s, rad/s: against the parent; du
    };
    void add_children(FlightLocks& locks, const std::vector<std::vector<std::uint32_t>>& joints_of, std::uint32_t root);
    static Vec3 arm_of(FlightLocks& locks, const Node& node);
    void list_frees(FlightLocks& locks, const Node& node);
    bool eliminate(Node& node);
    void gather(FlightLocks& locks, Node& node);
    double spread(FlightLocks& locks, Node& node);
    static double along(const Free& free, const SpatialForce& f) {
        return free.direction.dot(free.turns ? f.moment : f.force);
    }

    std::vector<Node> nodes_;  // parents before their children
    std::vector<Free> frees_;
    bool factored_ = false;  // the inertias are those of the subtrees
};

}  // namespace tumble
