// Tumble under test, in process.
#pragma once

#include "harness/simulator.h"
#include "scene/description/description.h"

#include <memory>

namespace tumble::bench {

struct TumbleSettings {
    IntegratorKind integrator = IntegratorKind::symplectic_euler;
    ImpactMode impacts = ImpactMode::stepped;
    ImpactLaw law = ImpactLaw::propagating;
    ContactSolverChoice contact_solver = ContactSolverChoice::by_island;
    bool sleep = false;
    int threads = 1;
};

std::unique_ptr<Simulator> make_tumble(const Scene& scene, double rate, const TumbleSettings& settings);

}  // namespace tumble::bench
