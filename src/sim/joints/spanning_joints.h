// A spanning tree of joined bodies: the joints that are its edges, and the joints that are cut. The ground is one node.
#pragma once

#include "sim/joints/joint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct SpanningJoints {
    static constexpr int ground = -1;

    std::vector<int> ends;   // two by joint: indices among the bodies; ground
    std::vector<char> kept;  // by joint: is in the tree
    std::vector<int> cut;    // the others, with gears and distance joints
    int rows = 0;            // locked coordinates of these
    bool free = true;        // no joint holds the bodies to the ground
};

/// Finds it for bodies (indices, ascending) and their joints; `all`: the joints that gears refer to. Returns false
/// where the joints do not connect the bodies, or a joint with laws would be cut.
bool span_joints(std::span<const std::uint32_t> bodies, std::span<const Joint* const> joints,
                 std::span<const Joint> all, SpanningJoints& tree);

/// True if span_joints() finds a tree, with no more rows than flight solves.
bool has_few_loops(std::span<const std::uint32_t> bodies, std::span<const Joint* const> joints,
                   std::span<const Joint> all);

}  // namespace tumble
