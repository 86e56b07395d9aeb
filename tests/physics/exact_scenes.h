// Shared by the tests of exact impacts: scenes in either mode, the energy, closed forms of bouncing.
#pragma once

#include "support/scenes.h"

#include <cmath>

namespace tumble::testing {

constexpr double gravity = 9.81;  // m/s^2, the scenes' default

/// Exact flights, and impacts at their own times.
inline void make_exact(SceneDescription& scene) {
    scene.simulation.integrator = IntegratorKind::exact;
    scene.simulation.impacts = ImpactMode::exact;
}

/// Steps of h seconds, one per frame.
inline void set_step(SceneDescription& scene, double rate) {
    scene.output.fps = rate;
    scene.simulation.steps_per_frame = 1;
}

inline BodyDescription& add_fixed_box(SceneDescription& scene, const Vec3& size, const Vec3& position,
                                      double restitution) {
    BodyDescription& wall = add_box(scene, size, position);
    wall.type = BodyType::fixed;
    wall.mass.reset();
    wall.restitution = restitution;
    return wall;
}

inline double energy(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

/// Clearance (m) of a body released at height h over the ground that keeps the fraction e of its speed at each bounce:
/// a fall of t0 = sqrt(2 h / gravity), then hops of 2 t0 e, 2 t0 e^2, ..., which end at t0 (1 + e) / (1 - e).
inline double bouncing_clearance(double h, double e, double t) {
    double speed = std::sqrt(2.0 * gravity * h), start = std::sqrt(2.0 * h / gravity);
    if (t < start) return h - 0.5 * gravity * t * t;
    if (e == 1.0) {  // all hops are equal: no sum is needed
        const double hop = 2.0 * start, s = std::fmod(t - start, hop);
        return speed * s - 0.5 * gravity * s * s;
    }
    for (speed *= e; speed > 1e-12; speed *= e) {
        const double hop = 2.0 * speed / gravity;
        if (t < start + hop) return speed * (t - start) - 0.5 * gravity * (t - start) * (t - start);
        start += hop;
    }
    return 0.0;
}
inline double time_of_rest(double h, double e) { return std::sqrt(2.0 * h / gravity) * (1.0 + e) / (1.0 - e); }

}  // namespace tumble::testing
