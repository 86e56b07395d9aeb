// Springs and dampers of a tree's joints as efforts along its coordinates, tau = K (rest - q) - C q', and their work.
#pragma once

#include "sim/articulation/forward_dynamics.h"
#include "sim/articulation/tree_step.h"

#include <vector>

namespace tumble {

class TreeSprings {
public:
    /// Of the present poses. Returns false where a spring acts along no single coordinate of the tree.
    bool find(const JointTree& tree, const TreeStep& step);
    bool empty() const { return list_.empty(); }
    /// Number of dampers: each has a heat, a coordinate of the motion that grows at C q'^2.
    int dampers() const { return dampers_; }
    /// Fastest rate (1/s) of a spring or damper, with its bodies free of other joints.
    double fastest() const { return fastest_; }

    /// After ForwardDynamics::move() with coordinates q and speeds; gives the heats' rates, W.
    void drive(ForwardDynamics& dynamics, const double* q, const double* speeds, double* heat_rates) const;
    /// Adds the work of the step to the joints' accounts, at its last coordinates and heats (J).
    void account(const TreeStep& step, const double* q, const double* heats) const;

private:
    struct Spring {
        int node = 0, joint = 0;
        int at = 0, speed_at = 0, heat = -1;  // places of its coordinate, speed and heat; without a damper: -1
        double stiffness = 0.0, damping = 0.0;
        double pull = 0.0;  // rest less value at the start, along the node's coordinate
    };
    std::vector<Spring> list_;
    int dampers_ = 0;
    double fastest_ = 0.0;
};

}  // namespace tumble
