// Reads memory into the cache ahead of its use. Processors foresee the strides of small elements only: a loop over
// elements of kilobytes waits for each of them otherwise.
#pragma once

#include <cstddef>

namespace tumble {

/// Elements between the one in use and the one that is fetched. Changes no result.
inline constexpr std::size_t elements_ahead = 4;

/// All lines from `begin` to `end`.
inline void fetch_ahead(const void* begin, const void* end) {
    constexpr std::size_t line = 64;  // bytes
    const char* from = static_cast<const char*>(begin);
    for (; from < static_cast<const char*>(end); from += line) __builtin_prefetch(from);
}

}  // namespace tumble
