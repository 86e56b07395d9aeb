// Springs and dampers of a tree's joints as efforts along its coordinates, tau = K (rest - q) - C q', and their work;
// and motors with one target, which are such springs up to a largest force.
#pragma once

#include "sim/articulation/forward_dynamics.h"
#include "sim/articulation/tree_step.h"

#include <vector>

namespace tumble {

class TreeSprings {
public:
    /// Finds the springs at the present poses. Returns false where a spring acts along no single coordinate of the
    /// tree. Springs and dampers that steps of `stage` s (0: of any length) do not resolve are stiff.
    bool find(const JointTree& tree, const TreeStep& step, double stage);
    bool empty() const { return list_.empty(); }
    /// Number of dampers, stiff springs and motors: each has a heat, a coordinate of the motion that grows at C q'^2,
    /// or a work, which grows at tau q'.
    int dampers() const { return dampers_; }
    bool any_stiff() const { return stiff_; }
    /// Fastest rate (1/s) of a spring or damper, with its bodies free of other joints.
    double fastest() const { return fastest_; }

    /// After ForwardDynamics::move() with coordinates q and speeds; gives the heats' rates, W.
    void drive(ForwardDynamics& dynamics, const double* q, const double* speeds, double* heat_rates) const;
    /// The same for a stage of `h` s of Verlet's method, from coordinates and speeds at its start, with coordinates in
    /// its middle: dampers follow the mean of the speeds, and stiff springs are implicit, by inertias (`first`) that
    /// are added.
    void drive_stage(ForwardDynamics& dynamics, const double* start, const double* speeds, const double* middle,
                     double h, bool first) const;
    /// Adds the heats of the stage, which ends at speeds `after`.
    void heat_stage(const double* start, const double* speeds, const double* middle, const double* after, double h,
                    double* heats) const;
    /// True if no motor gives more than its largest force.
    bool within_bounds(const double* q, const double* speeds) const;
    /// Adds the work of the step to the joints' accounts, at its last coordinates and heats (J).
    void account(const TreeStep& step, const double* q, const double* heats) const;

private:
    struct Spring {
        int node = 0, joint = 0;
        int at = 0, speed_at = 0, heat = -1;  // indices of its coordinate, speed and heat; without a damper: -1
        double stiffness = 0.0, damping = 0.0;
        double pull = 0.0;       // rest less value at the start, along the node's coordinate
        double most = infinity;  // N m, N
        bool motor = false, stiff = false;

        double effort_at(const double* q, const double* speeds) const {
            return stiffness * (pull - q[at]) - damping * speeds[speed_at];
        }

        // J; heats of motors are their work.
        double work(const double* q, const double* heats) const {
            if (motor) return heats[heat];
            const double moved = q[at];
            return stiffness * moved * (pull - 0.5 * moved) - (heat >= 0 ? heats[heat] : 0.0);
        }

        double inertia(double h) const { return stiff ? h * (damping + h * stiffness) : 0.5 * h * damping; }
        // In a stage of Verlet's method, at unchanged speed; less inertia times acceleration.
        double effort(const double* start, const double* speeds, const double* middle, double h) const {
            const double u = speeds[speed_at];
            return stiffness * (pull - (stiff ? start[at] + h * u : middle[at])) - damping * u;
        }
    };
    std::vector<Spring> list_;
    int dampers_ = 0;
    bool stiff_ = false;
    double fastest_ = 0.0;
};

}  // namespace tumble
