// Projection of gaps: the least displacements, in the metric of the masses, that close the joints of a tree.
//   minimize du^T M du / 2   under   J du = -g
// From the leaves to the root each subtree is replaced by its inertia about its joint, less what the free directions of
// the joint do not pass on; the displacements follow from the root to the leaves. Momenta stay, and so does
// the center of mass of a tree without an anchor.
#pragma once

#include "sim/articulation/spatial.h"
#include "sim/joints/joint_groups.h"
#include "sim/joints/joint_set.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class Projection {
public:
    /// The trees of joints, found anew when joints begin or end to hold.
    void find(const JointSet& joints, const std::vector<Body>& bodies);
    /// True if all joints of an island are closed: none of its groups has a loop.
    bool closes(std::span<const std::uint32_t> island) const {
        return std::none_of(island.begin(), island.end(), [&](std::uint32_t i) { return loops_[i] != 0; });
    }
    /// Prepares for calls from so many threads.
    void prepare(std::size_t threads) { links_.resize(std::max(links_.size(), threads)); }

    /// Closes the trees of an island at the end of a step of `h` s: carriers move after it, by their velocities. Groups
    /// with loops stay as they are. Returns the sum of all displacements x momenta, N m s, which the angular momentum
    /// has gained.
    Vec3 close(std::span<const std::uint32_t> island, std::vector<Body>& bodies, double h, std::size_t thread);

private:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// A body, with the joint to its parent: to another body of the tree, to one that stands still or to the world.
    struct Node {
        std::uint32_t body = none, parent = none;
        std::uint32_t still = none;  // body on the other side of an anchor
        bool joined = false;
        bool is_b = true;  // the body is B of the joint
        JointLocks locks;
        bool turns_free = true;  // no turn is locked
        double size = 0.0;       // m, unit of tolerances
        Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();
        Quat frame_a = Quat::Identity(), frame_b = Quat::Identity();
    };
    struct Tree {
        std::size_t first, end;  // nodes
    };
    /// A direction in which a joint lets its body move against its parent, or in which a root moves.
    struct Free {
        Vec3 direction = Vec3::Zero();  // world, unit vector
        bool turns = false;
        SpatialForce inertia;  // I s, of the subtree without the directions before this one
        double pivot = 0.0;    // 1 / (s . I s)
        double effort = 0.0;   // impulse along it
    };
    /// A node in the passes. Inertias and motions are about its joint, those of a root without one about its center of
    /// mass.
    struct Link {
        Vec3 position;
        Quat orientation;
        Mat3 rotation;
        Vec3 reference;          // m, world
        Vec3 arm, lever;         // m, to it from the center of mass, and from the reference of the parent
        SpatialInertia inertia;  // of the subtree
        SpatialForce impulse;    // from the subtrees behind
        SpatialMotion asked, change;
        Free free[6];
        int frees = 0;
    };
    void add_tree(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies);
    bool close(const Tree& tree, std::vector<Body>& bodies, double h, std::vector<Link>& links);
    double measure(const Tree& tree, std::size_t i, const std::vector<Body>& bodies, double h, std::vector<Link>& links,
                   bool refresh) const;
    static void load_inertia(const Body& body, Link& link);
    static bool eliminate(Link& link, Link* parent);
    static void gather(Link& link, Link* parent);
    static void spread(Link& link, const Link* parent);

    std::vector<Node> nodes_;  // tree by tree, parents before their children
    std::vector<Tree> trees_;
    std::vector<std::uint32_t> tree_of_;       // by body: of whose tree it is the lowest; none for others
    std::vector<std::uint8_t> loops_;          // by body: of a group with loops
    std::vector<std::vector<Link>> links_;     // by thread
    std::uint64_t found_ = ~std::uint64_t(0);  // JointSet::changes() of the trees
};

}  // namespace tumble
