#include "app/cli/simulation_cost.h"

#include "app/threads/wall_clock.h"
#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tumble {
namespace {

constexpr double longest_trial = 4.0;   // s of processor time: all demo scenes but the largest are done by then
constexpr double longest_coarse = 2.0;  // s
constexpr int coarsening = 8;           // a step of the copy is as long as so many; falling bodies still come to rest

using Times = std::vector<double>;  // s of processor time, by frame

double sum(const Times& times, std::size_t first, std::size_t end) {
    return std::accumulate(times.begin() + std::ptrdiff_t(first), times.begin() + std::ptrdiff_t(end), 0.0);
}

/// The times of the first frames, at least one.
Times times_of(World& world, std::int64_t frames, double longest) {
    Times times;
    const double start = thread_seconds();
    double before = start;
    while (std::int64_t(times.size()) < frames && before - start < longest) {
        world.advance_frame();
        const double now = thread_seconds();
        times.push_back(now - before);
        before = now;
    }
    return times;
}

/// The times of a copy with longer steps; none if it fails, which a copy may do alone.
Times coarse_times(const SceneDescription& scene, std::int64_t frames) {
    FrameTiming timing = scene.timing();
    timing.steps_per_frame = std::max(1, timing.steps_per_frame / coarsening);
    try {
        World world(scene, timing, 1);
        return times_of(world, frames, longest_coarse);
    } catch (const RunError&) {
        return {};
    }
}

/// The time of `frames` frames, whose first ones took `times`.
double extrapolated(const Times& times, std::int64_t frames) {
    const std::size_t done = times.size(), last = std::max<std::size_t>(1, done / 4);
    return sum(times, 0, done) + sum(times, done - last, done) / double(last) * double(frames - std::int64_t(done));
}

double estimate(const SceneDescription& scene, const Times& times, std::int64_t frames) {
    const Times coarse = coarse_times(scene, frames);
    if (coarse.size() <= times.size()) return extrapolated(times, frames);
    const double seconds = sum(times, 0, times.size()), of_copy = sum(coarse, 0, times.size());
    return seconds + seconds / of_copy * (extrapolated(coarse, frames) - of_copy);
}

}  // namespace

std::string simulation_cost(const SceneDescription& scene, World& world) {
    const std::int64_t frames = scene.frame_count() - 1;
    if (frames <= 0) return "nothing to simulate";
    try {
        const Times times = times_of(world, frames, longest_trial);
        if (std::int64_t(times.size()) == frames)
            return fmt::format("{:.3g} s of processor time, on one thread", sum(times, 0, times.size()));
        return fmt::format("about {:.2g} s of processor time on one thread, estimated", estimate(scene, times, frames));
    } catch (const RunError& error) {
        return fmt::format("the simulation fails: {}", error.what());
    }
}

}  // namespace tumble
