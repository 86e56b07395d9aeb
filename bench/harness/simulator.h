// Interface of a program under test: a world that steps.
#pragma once

#include "harness/scene.h"

#include <cstddef>

namespace tumble::bench {

/// Sums over all bodies that move, pieces of broken ones too.
struct Totals {
    Vector momentum, angular_momentum;  // kg m/s, and kg m^2/s about the origin
    double kinetic = 0.0;               // J
    std::size_t bodies = 0;
};

class Simulator {
public:
    virtual ~Simulator() = default;
    virtual void step() = 0;
    virtual Motion motion(std::size_t body) const = 0;  // index in the scene; for moving bodies
    /// When the joint broke, s; empty while it holds, and where a program does not tell it.
    virtual std::optional<double> broken_at(std::size_t) const { return std::nullopt; }
    /// Empty where a program has no bodies that break.
    virtual std::optional<Totals> totals() const { return std::nullopt; }
    /// Force of the joint on its second body in the last step, N, world frame; empty where a program does not tell it.
    virtual std::optional<Vector> joint_force(std::size_t) const { return std::nullopt; }
};

}  // namespace tumble::bench
