// Numbers of items from which on several threads share the work. No result depends on them.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Pairs or islands from which on other threads are woken. Limits the cost.
inline constexpr std::size_t parallel_grain = 64;

/// Bodies from which on threads share the work, whose forces are applied or whose poses are advanced. Limits the cost.
inline constexpr std::size_t parallel_bodies = 512;

}  // namespace tumble::tuning
