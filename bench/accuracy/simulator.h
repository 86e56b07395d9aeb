// The variants in which a program can step, for the accuracy benchmark.
#pragma once

#include "harness/simulator.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble::bench {

/// Demand of a case on a program: free flights; impacts; the energy of a crowd, sampled during impacts too; impacts
/// between steps; rows of touching bodies hit at once, whose result depends on the law: propagating, or Newton's law
/// for all contacts at once.
enum class Demand { flight, impact, crowd, thin_wall, row_propagating, row_simultaneous };

struct Variant {
    std::string name;  // integrator and impact mode, or the solver of a peer
    std::function<bool(Demand)> meets;
    /// A world of `rate` steps per second; null where the program cannot represent the scene.
    std::function<std::unique_ptr<Simulator>(const Scene&, double rate)> make;
    bool step_free = false;  // impacts have their own times: a step may have any length
};

}  // namespace tumble::bench
