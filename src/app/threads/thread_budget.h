// Default number of simulation threads beside the render processes. The result is the same for any number.
#pragma once

#include <cstddef>

namespace tumble {

/// Upper limit of numbers of threads or processes; more are considered a mistake.
inline constexpr int most_threads = 256;

/// Number of processor cores.
int machine_threads();

/// At least 1, at most `cores`.
int simulation_threads_beside_drawing(std::size_t bodies, int cores);

}  // namespace tumble
