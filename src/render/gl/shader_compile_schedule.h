// Which of the processes that draw the same scene compiles which shader first. Mesa keeps what it compiles on disk, where the
// others find it: so each compiles a part of all shaders, and reads the rest. Without that cache, or where a process is too
// late, a shader is compiled again: the pixels are the same in any case.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <span>

namespace tumble {

/// Lies in memory that the processes share; zeroed memory is a fresh one.
class ShaderCompileSchedule {
public:
    static constexpr std::size_t most = 32;   // shaders beyond it are left to their first use

    /// Runs those parts that no other process has taken, in order, and waits until the others' are done, too. Every process
    /// must come with the same list, the longest parts first: then all end at about the same time.
    void run(std::span<const std::function<void()>> parts);

private:
    enum State : unsigned char { open, taken, done };

    std::array<std::atomic<unsigned char>, most> states_{};
    static_assert(std::atomic<unsigned char>::is_always_lock_free);   // else it would not work between processes
};

}  // namespace tumble
