// Finds bodies with a state that is not finite, and stops the simulation.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/threads/thread_pool.h"

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class StateCheck {
public:
    /// Checks a body; any thread may call it.
    void examine(std::uint32_t body, const std::vector<Body>& bodies);
    void examine(std::span<const std::uint32_t> chosen, const std::vector<Body>& bodies, ThreadPool& pool);

    /// Index of the lowest body found, by any thread; `none` if all are finite.
    std::uint32_t found() const { return first_; }
    static constexpr std::uint32_t none = UINT32_MAX;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [first] = self;
        archive.rebuilt(first);
    }

private:
    std::atomic<std::uint32_t> first_{none};
};

struct StepContext;
/// Throws RunError that names the step and the body if any state found so far is not finite.
void stop_if_not_finite(const StepContext& step);

}  // namespace tumble
