// Which bodies may touch: a tree over the moving bodies' fattened bounds, one over the fixed bodies, and a list of the
// half-spaces. Built again only when a body has left its fat bounds: n log n then, n otherwise.
#pragma once

#include "sim/body.h"
#include "sim/collision/bounds_tree.h"

#include <cstdint>
#include <vector>

namespace tumble {

class BroadPhase {
public:
    struct Pair {
        std::uint32_t a, b;   // a < b; at least one is dynamic
        friend auto operator<=>(const Pair&, const Pair&) = default;
    };

    /// The pairs for the bodies' present poses and speeds, ascending. h: the step, s.
    const std::vector<Pair>& update(const std::vector<Body>& bodies, double h);

private:
    void rebuild(const std::vector<Body>& bodies, double h);

    std::vector<std::uint32_t> moving_, fixed_, half_spaces_;
    BoundsTree moving_tree_, fixed_tree_;
    std::vector<Pair> pairs_;
    bool built_ = false;
};

/// How far (m) the body's contacts are looked for: a part of its size, and its way in a step.
double contact_margin(const Body& body, double h);

}  // namespace tumble
