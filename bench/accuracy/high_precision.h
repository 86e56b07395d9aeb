// References in 113-bit arithmetic, by code that shares nothing with the simulation: Gragg's modified midpoint rule
// with Bulirsch and Stoer's extrapolation (Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", II.9).
#pragma once

#include "harness/scene.h"

#include <array>
#include <vector>

namespace tumble::bench {

__extension__ typedef __float128 Quad;

Quad square_root(Quad x);

/// x, v (world), q (body to world), w (body): y[0..2], y[3..5], y[6..9] = w x y z, y[10..12].
using QuadState = std::array<Quad, 13>;

/// The motion of body 0, a box, of a scene without contacts under its gravity, air and push.
class ReferenceFlight {
public:
    explicit ReferenceFlight(const Scene& scene);
    /// Advances the motion by h seconds; exact to some 1e-25 while h |w| is below one.
    void advance(Quad h);
    const QuadState& state() const { return state_; }

    double position_error(const Motion& motion) const;     // m
    double orientation_error(const Motion& motion) const;  // rad, the angle between the two

private:
    QuadState rate(const QuadState& y) const;

    Scene scene_;
    std::array<Quad, 3> inertia_;
    QuadState state_;
};

}  // namespace tumble::bench
