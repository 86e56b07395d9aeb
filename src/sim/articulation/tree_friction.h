// Dry friction of a tree's joints, of a constant bound: an effort against the motion of a coordinate, or a coordinate at
// rest that is held while the effort which that takes is within the bound. Both are smooth between the moments in which
// a coordinate comes to rest or is let go.
#pragma once

#include "sim/articulation/forward_dynamics.h"
#include "sim/articulation/tree_step.h"

#include <cstddef>
#include <vector>

namespace tumble {

class TreeFriction {
public:
    void find(const JointTree& tree, const TreeStep& step);
    bool empty() const { return list_.empty(); }

    /// Directions of motion at the start. Speeds (rad/s, m/s) that are rounding beside the fastest body (m/s) become 0.
    void begin(double* speeds, double fastest, double length);
    /// After ForwardDynamics::move(): efforts against the motion, and holds.
    void drive(ForwardDynamics& dynamics) const;

    /// How far a coordinate is beyond its next change, after ForwardDynamics::accelerate(): its speed against its
    /// direction, or the effort above its bound. Negative before the change.
    double excess(std::size_t k, const ForwardDynamics& dynamics, const double* speeds) const;
    /// Unit of excess(): the bound of a held coordinate, or the speed of another one at the start of a part.
    double unit(std::size_t k, const double* speeds) const;
    /// A coordinate that moves from speed to speed (both along its direction) and is slower between them, by the cubic
    /// through both ends of a part of `h` s: the share of the part at its least speed, if that is against its direction.
    /// Else 0.
    double turns_back_at(std::size_t k, const double* speeds, const double* rates, const double* end_speeds,
                         const double* end_rates, double h) const;

    /// A coordinate is at rest, or let go, at coordinates q; `net`: the effort that a held one needs.
    void change(std::size_t k, const double* q, double* speeds, double net);
    /// Of coordinates at rest, after accelerate() with drive(): holds those that would move against their direction, and
    /// lets those go that need more than their bound; of one alone or of all. Returns whether there were any.
    bool revise(const ForwardDynamics& dynamics, const double* speeds, const double* rates, bool one);
    double net(std::size_t k, const ForwardDynamics& dynamics) const { return dynamics.net_effort(list_[k].node); }
    std::size_t count() const { return list_.size(); }

    /// Adds the heat of the step to the joints' accounts, and gives the joints the impulses of friction, at the last
    /// coordinates; after accelerate().
    void account(const TreeStep& step, const ForwardDynamics& dynamics, const double* q);

private:
    struct Friction {
        int node = 0, joint = 0;
        int at = 0, speed_at = 0;  // places of its coordinate and speed
        std::uint8_t coordinate = 0;
        double sign = 1.0;   // of the joint's coordinate along the node's own
        double bound = 0.0;  // N m, N
        double way = 0.0;    // direction of motion along the node's coordinate; 0: held
        double since = 0.0;  // coordinate at the last change
        double heat = 0.0;   // J, up to the last change
    };
    std::vector<Friction> list_;
};

}  // namespace tumble
