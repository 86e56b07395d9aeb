// Integer channels by their differences: of the order 0 to 3 that makes them smallest.
#pragma once

#include <cstdint>
#include <span>

namespace tumble {

/// Replaces a channel by its differences and returns their order. Differences of order n + 1 are the differences of
/// the differences of order n; the value before the first is 0.
int predict(std::span<std::int64_t> channel);

}  // namespace tumble
