// Limits of a tree's coordinates as modes of the motion. A coordinate that meets its limit rebounds by an impulse along
// it alone; one that would be back at once is held while its load presses it on, and let go when that points inwards.
// The swing and the twist of a ball have no coordinate: their rates are forms n . w of its speeds w, in the parent's
// frame.
#pragma once

#include "sim/articulation/tree_closures.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace tumble {

class TreeLimits {
public:
    /// Finds the limits of the present poses. Returns false where a limit is violated, or a ball in a loop has one.
    /// Impulses act with the closures.
    bool find(const JointTree& tree, const TreeStep& step, TreeClosures& closures);
    void clear() { list_.clear(); }
    bool empty() const { return list_.empty(); }
    std::size_t count() const { return list_.size(); }
    /// True if excess() needs ForwardDynamics::accelerate(): a coordinate is held, or a ball has limits.
    bool needs_rates() const;

    /// After ForwardDynamics::move(): speeds (rad/s, m/s) at limits that are rounding beside the fastest body (m/s)
    /// become 0.
    void begin(const ForwardDynamics& dynamics, double* speeds, double fastest, double length);
    /// After ForwardDynamics::move(): holds.
    void drive(ForwardDynamics& dynamics, const double* speeds) const;

    /// m or rad, at most 0 while nothing happens: how far a coordinate is beyond its limit; N or N m: how far the net
    /// effort on a held one points inwards. After ForwardDynamics::move() and, where needs_rates(), accelerate().
    double excess(std::size_t k, const ForwardDynamics& dynamics, const double* q) const;
    double unit(std::size_t k) const;
    /// A coordinate that is within its limit at both ends of a part of `h` s, and beyond it between them, by the cubic
    /// through both: the share of the part at its farthest point. Otherwise 0.
    double passes_at(std::size_t k, const double* q, const double* speeds, const double* end, const double* end_speeds,
                     double h) const;

    bool held(std::size_t k) const { return list_[k].held; }
    void let_go(std::size_t k) { list_[k].held = list_[k].rests = false; }
    /// True if the coordinate is at its limit, and moves towards it; after ForwardDynamics::move().
    bool strikes(std::size_t k, const ForwardDynamics& dynamics, const double* q, const double* speeds) const;

    /// An impact of one limit. Held coordinates pass it on while it presses them to their limits, and leave them
    /// otherwise.
    struct Impact {
        double approach = 0.0;  // rad/s, m/s
        double impulse = 0.0;   // N m s, N s
        bool rebounds = false;
    };
    /// Changes the speeds; the dynamics are then those of the impact, with impulses instead of forces. A rebound that
    /// would end within a share of `span` s does not happen; `rates` gives the rates of the speeds after the impact.
    /// Without an approach nothing happens.
    Impact strike(std::size_t k, ForwardDynamics& dynamics, double* q, double* speeds, std::size_t numbers, double span,
                  const std::function<const double*()>& rates);

    /// Holds coordinates at rest at their limits that would move beyond, after accelerate() with drive(), and lets
    /// those go that would leave; of one alone or of all. Returns whether there were any.
    bool revise(const ForwardDynamics& dynamics, const double* q, const double* speeds, const double* rates,
                std::size_t numbers, bool one);

    /// Both limits of a ball hold it, which the rows of the contact solver do.
    bool holds_twice() const;

    /// Adds the losses of the step to the joints' accounts, and gives the joints the loads of their limits; after
    /// accelerate().
    void account(const TreeStep& step, const ForwardDynamics& dynamics) const;

private:
    struct Limit {
        int node = 0, joint = 0;
        int at = 0, speed_at = 0;  // indices of its coordinate and speed
        std::uint8_t coordinate = 0;
        Joint::Law law = Joint::lower;
        double sign = 1.0;  // of the joint's coordinate along the node's own; of a ball, of the second body's turn
        double side = 1.0;  // of the allowed range, along the node's coordinate
        double room = 0.0;  // m, rad: to the limit, at the start
        double size = 1.0;  // m, rad: unit of tolerances
        double restitution = 0.0;
        bool ball = false;
        bool held = false;
        bool rests = false;  // of a ball: at its limit, at rest along n
        double load = 0.0;   // N, N m: largest on the limit
        double lost = 0.0;   // J
    };
    void add_joint(const JointTree& tree, int node, const TreeStep& step);
    double room(const Limit& limit, const ForwardDynamics& dynamics, const double* q) const;
    Vec3 inward_of_ball(const Limit& limit, const ForwardDynamics& dynamics, double ahead = 0.0) const;
    double curve_of_ball(const Limit& limit, const ForwardDynamics& dynamics, const double* speeds) const;
    JointGeometry measure_ball(const Limit& limit, const ForwardDynamics& dynamics, double ahead = 0.0) const;
    double net_effort(const Limit& limit, const ForwardDynamics& dynamics) const;
    bool rests(const Limit& limit, const double* q, const double* speeds) const;
    void hold(const Limit& limit, ForwardDynamics& dynamics, const double* speeds) const;
    double inwards(std::size_t k, const ForwardDynamics& dynamics, const double* speeds) const;
    bool ends_within(std::size_t k, double approach, double load, double span) const;
    void respond(std::size_t k, Impact& impact, ForwardDynamics& dynamics, double* q, double* speeds,
                 std::size_t numbers);

    std::vector<Limit> list_;
    const JointTree* tree_ = nullptr;
    const TreeStep* step_ = nullptr;
    TreeClosures* closures_ = nullptr;
    bool balls_ = false;
};

}  // namespace tumble
