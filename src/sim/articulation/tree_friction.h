// Dry friction of a tree's joints, of a constant bound: an effort against the motion of a coordinate, or a coordinate
// at rest that is held while the effort which that takes is within the bound. Both are smooth between the moments in
// which a coordinate comes to rest or is let go. A motor with a speed is friction against the motion relative to that
// speed.
#pragma once

#include "sim/articulation/forward_dynamics.h"
#include "sim/articulation/tree_step.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace tumble {

class TreeFriction {
public:
    void find(const JointTree& tree, const TreeStep& step);
    /// Number of motors: each has a work, a coordinate of the motion.
    int motors() const { return motors_; }
    bool empty() const { return list_.empty(); }

    /// Directions of motion at the start. Speeds (rad/s, m/s) that are rounding beside the fastest body (m/s) become 0.
    void begin(double* speeds, double fastest, double length);
    /// After ForwardDynamics::accelerate(): rates of the works of motors, W.
    void find_powers(const ForwardDynamics& dynamics, const double* speeds, double* powers) const;
    /// After ForwardDynamics::move(): efforts against the motion, and holds.
    void drive(ForwardDynamics& dynamics) const;
    /// Holds alone, for impulses.
    void hold(ForwardDynamics& dynamics) const;

    /// How far a coordinate is beyond its next change, after ForwardDynamics::accelerate(): its speed against its
    /// direction, or the effort above its bound. Negative before the change.
    double excess(std::size_t k, const ForwardDynamics& dynamics, const double* speeds) const;
    /// Unit of excess(): the bound of a held coordinate, or the speed of another one at the start of a part.
    double unit(std::size_t k, const double* speeds) const;
    /// A coordinate that moves from speed to speed (both along its direction) and is slower between them, by the cubic
    /// through both ends of a part of `h` s: the share of the part at its least speed, if that is against its
    /// direction. Otherwise 0.
    double turns_back_at(std::size_t k, const double* speeds, const double* rates, const double* end_speeds,
                         const double* end_rates, double h) const;

    /// A coordinate is at rest, or let go, at coordinates q; `net`: the effort that a held one needs.
    void change(std::size_t k, const double* q, double* speeds, double net);
    /// Holds coordinates at rest that would move against their direction, after accelerate() with drive(), and lets
    /// those go that need more than their bound; of one alone or of all. Returns whether there were any.
    bool revise(const ForwardDynamics& dynamics, const double* speeds, const double* rates, bool one);
    /// After an impact at coordinates q: the directions of motion anew.
    void strike(const double* q, const double* speeds);
    double net(std::size_t k, const ForwardDynamics& dynamics) const { return dynamics.net_effort(list_[k].node); }
    std::size_t count() const { return list_.size(); }

    /// J: works of motors less the heat, up to the coordinates and works.
    double work(const double* q, const double* works) const;
    /// Adds the heat and the works (J, of motors) of the step to the joints' accounts, and gives the joints the
    /// impulses of friction and motors, at the last coordinates; after accelerate().
    void account(const TreeStep& step, const ForwardDynamics& dynamics, const double* q, const double* works) const;

private:
    struct Friction {
        int node = 0, joint = 0;
        int at = 0, speed_at = 0;  // indices of its coordinate and speed
        std::uint8_t coordinate = 0;
        double sign = 1.0;   // of the joint's coordinate along the node's own
        double bound = 0.0;  // N m, N
        double speed = 0.0;  // rad/s, m/s, along the node's coordinate: of a motor
        int work = -1;       // index of a motor's work; friction: -1
        double way = 0.0;    // direction of the relative motion along the node's coordinate; 0: held
        double since = 0.0;  // coordinate at the last change
        double heat = 0.0;   // J, up to the last change
    };
    static double effort(const Friction& f, const ForwardDynamics& dynamics);
    static double heat(const Friction& f, const double* q) { return f.heat + f.bound * std::abs(q[f.at] - f.since); }

    std::vector<Friction> list_;
    int motors_ = 0;
};

}  // namespace tumble
