// Distributes shader compilation over the processes that draw the same scene. Mesa caches compiled shaders on disk, and
// the processes share that cache: each compiles a part of all shaders and reads the rest. Without the cache, or if a
// process is too late, a shader is compiled again; the pixels are the same in all cases.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <span>

namespace tumble {

/// Placed in memory that the processes share; zeroed memory is a valid initial state.
class ShaderCompileSchedule {
public:
    static constexpr std::size_t most = 32;  // further shaders are compiled at their first use

    /// Runs the parts that no other process has taken, in order, then waits for the parts of the others. Every process
    /// must pass the same list, the longest parts first, so that all end at about the same time.
    void run(std::span<const std::function<void()>> parts);

private:
    enum State : unsigned char { open, taken, done };

    std::array<std::atomic<unsigned char>, most> states_{};
    static_assert(std::atomic<unsigned char>::is_always_lock_free);  // otherwise it would not work between processes
};

}  // namespace tumble
