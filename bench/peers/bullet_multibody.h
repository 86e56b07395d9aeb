// Bullet's btMultiBody: trees of bodies in joint coordinates, by Featherstone's algorithm; loops are constraints.
#pragma once

#include "harness/simulator.h"

#include <memory>

namespace tumble::bench {

struct MultibodySettings {
    int iterations = 10;
    bool rk4 = false;  // otherwise semi-implicit Euler
};

/// Null where multibodies cannot represent the scene: with distances, loops of sliders, cones and breaking joints.
std::unique_ptr<Simulator> make_bullet_multibody(const Scene& scene, double rate, const MultibodySettings& settings);

}  // namespace tumble::bench
