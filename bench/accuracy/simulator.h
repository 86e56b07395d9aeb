// The ways (variants) in which a program can be asked to step, for the accuracy benchmark.
#pragma once

#include "harness/simulator.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble::bench {

/// What a case asks of a program: free flights; impacts; a crowd's energy, looked at in the middle of impacts too;
/// impacts that fall between steps; rows of touching bodies struck at once, whose outcome depends on the law: the blow
/// is handed on, or Newton's law holds for all contacts at once.
enum class Demand { flight, impact, crowd, thin_wall, row_propagating, row_simultaneous };

struct Variant {
    std::string name;  // integrator and impact mode, or the solver of a peer
    std::function<bool(Demand)> meets;
    /// A world that takes `rate` steps a second; null where the program cannot hold the scene.
    std::function<std::unique_ptr<Simulator>(const Scene&, double rate)> make;
    bool step_free = false;  // impacts have their own times: a step may be as long as one likes
};

}  // namespace tumble::bench
