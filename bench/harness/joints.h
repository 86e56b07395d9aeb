// Joints of a scene for the programs that want a tree, and their gaps for the observers.
#pragma once

#include "harness/scene.h"

namespace tumble::bench {

/// True if `body` is the world or a body that does not move.
bool is_fixed(const Scene& scene, std::size_t body);

/// A spanning forest of the joint graph, by breadth: from the world where a group of bodies is joined to it, otherwise
/// from the middle of the group, so that it is as shallow as it can be. Distance joints are no edges of the forest.
struct JointForest {
    struct Node {
        std::size_t body = 0;
        std::size_t parent = the_world;  // a body, or the world
        std::size_t joint = the_world;   // index of the joint to the parent; `the_world`: none, the body is free
        std::size_t root = 0;            // the first body of its tree; each body that is joined to the world is a root
        std::size_t depth = 0;           // 0: a root
    };
    std::vector<Node> nodes;         // all moving bodies, tree by tree, a parent before its children
    std::vector<std::size_t> loops;  // indices of the joints that close loops
};
JointForest forest_of(const Scene& scene);

/// The axis such that the coordinate of the joint grows when `child` moves along it relative to the other body.
Vector axis_for(const Joint& joint, std::size_t child);

/// Velocity of a point of the body; world frame, m/s. The world's is 0.
Vector velocity_at(const Scene& scene, std::size_t body, const Vector& point);
Vector spin_of(const Scene& scene, std::size_t body);  // rad/s

/// Largest error of the joints: m; errors of angles times the reach of the smaller body.
double largest_gap(const Scene& scene, const std::vector<Motion>& motions);

/// Largest angle beyond a limit of a hinge or beyond a cone, rad.
double largest_excess(const Scene& scene, const std::vector<Motion>& motions);

/// Where a point of a body at the start has gone.
Vector moved(const Scene& scene, std::size_t body, const Motion& motion, const Vector& point);

/// True if a kind of joint or one of its features occurs.
bool has_kind(const Scene& scene, JointKind kind);
bool has_cones(const Scene& scene);
/// True if a joint must break.
bool needs_breaking(const Scene& scene);

}  // namespace tumble::bench
