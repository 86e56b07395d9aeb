// How many threads the simulation gets beside the processes that draw, where nobody says. The result is the same for any number.
#pragma once

#include <cstddef>

namespace tumble {

/// More threads, or processes, than this are a mistake.
inline constexpr int most_threads = 256;

/// One a core.
int machine_threads();

/// At least 1, at most `cores`.
int simulation_threads_beside_drawing(std::size_t bodies, int cores);

}  // namespace tumble
