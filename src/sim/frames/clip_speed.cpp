#include "sim/frames/clip_speed.h"

#include "core/error.h"
#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "scene/toml/limits.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

constexpr double least_steps = 4.0;  // of an interval: rounding moves a frame by at most an eighth of its motion
constexpr int most_divisions = 4;    // of that division, in search of one for which no frame is rounded
constexpr int speed_parts = 32;      // of a frame, to integrate the speed

/// The number by which to divide the scene's step. Throws InputError where it is out of reach.
int division(const SceneDescription& scene, double speed, int intervals) {
    const double usual = scene.simulation.steps_per_frame * speed / intervals;  // steps in an interval
    double slowest = usual;
    for (const SpeedKeyframe& key : scene.speed) slowest = std::min(slowest, usual * key.factor);
    const double needed = std::max(1.0, std::ceil(rounded_if_nearly_whole(least_steps / slowest)));
    if (needed > double(limits::steps_per_frame))
        throw InputError(fmt::format("[[speed]]: the slowest frame divides a step into more than {} parts (given {:g})",
                                     limits::steps_per_frame, needed));
    const int least = int(needed);
    const auto whole = [&](int divided) {
        const auto is_whole = [&](double steps) {
            return rounded_if_nearly_whole(steps * divided) == std::round(steps * divided);
        };
        return is_whole(usual) &&
               std::ranges::all_of(scene.speed, [&](const SpeedKeyframe& key) { return is_whole(usual * key.factor); });
    };
    for (int divided = least; divided <= most_divisions * least; ++divided)
        if (whole(divided)) return divided;
    return least;
}

/// The factor at a time of the scene.
double factor_at(const std::vector<SpeedKeyframe>& keys, double time) {
    const auto next = std::ranges::upper_bound(keys, time, {}, &SpeedKeyframe::time);
    if (next == keys.begin()) return 1.0;
    const SpeedKeyframe& key = *std::prev(next);
    if (next == keys.end() || key.easing == SpeedEasing::step) return key.factor;
    const double part = (time - key.time) / (next->time - key.time);
    const double eased = key.easing == SpeedEasing::smooth ? part * part * (3.0 - 2.0 * part) : part;
    return key.factor + eased * (next->factor - key.factor);
}

/// The time of the next frame, without holds.
double next_time(const std::vector<SpeedKeyframe>& keys, double speed, double fps, double time) {
    for (int i = 0; i < speed_parts; ++i) {
        const double half = 0.5 / speed_parts / fps * speed;  // midpoint rule
        time += 2.0 * half * factor_at(keys, time + half * factor_at(keys, time));
    }
    return time;
}

}  // namespace

FrameTiming timing_at_speeds(const SceneDescription& scene, double speed, const Shutter& shutter) {
    const int divided = division(scene, speed, shutter.intervals);
    const double steps = std::max(1.0, std::ceil(rounded_if_nearly_whole(scene.simulation.steps_per_frame * speed *
                                                                         divided / shutter.intervals)));
    if (steps > double(limits::steps_per_frame))
        throw InputError(fmt::format("[[speed]]: a frame takes more than {} steps", limits::steps_per_frame));
    return {scene.output.fps / speed * shutter.intervals, int(steps)};
}

ClipSpeed clip_speed(const SceneDescription& scene, const FrameTiming& timing) {
    ClipSpeed found;
    std::vector<std::optional<double>> impacts(scene.speed.size());
    const auto open = [&](std::size_t k) { return scene.speed[k].impact && !impacts[k]; };
    std::size_t left = 0;
    for (std::size_t k = 0; k < impacts.size(); ++k) left += open(k);
    if (left > 0) {
        World world(scene, timing, 1);
        world.record_contacts();
        const std::int64_t frames = timing.frame_count(scene.simulation.duration);
        for (std::int64_t n = 1; n < frames && left > 0; ++n) {
            try {
                world.advance_frame();
            } catch (const RunError&) {
                break;  // the clip's own run fails at the same place
            }
            for (const ImpactRecord& impact : world.contact_records().impacts)
                for (std::size_t k = 0; k < impacts.size(); ++k) {
                    if (!open(k)) continue;
                    const auto [a, b] = *scene.speed[k].impact;
                    if ((impact.a != a || impact.b != b) && (impact.a != b || impact.b != a)) continue;
                    impacts[k] = impact.when.time;
                    --left;
                }
        }
    }
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        SpeedKeyframe key = scene.speed[k];
        if (open(k)) {
            const auto [a, b] = *key.impact;
            found.missing.push_back(
                fmt::format("{} and {}", safe_text(scene.bodies[a].name), safe_text(scene.bodies[b].name)));
            continue;
        }
        if (key.impact) key.time = std::max(0.0, key.time + *impacts[k]);
        key.impact.reset();
        found.keys.push_back(key);
    }
    std::ranges::stable_sort(found.keys, {}, &SpeedKeyframe::time);
    return found;
}

std::vector<int> steps_of_frames(const SceneDescription& scene, const std::vector<SpeedKeyframe>& keys, double speed,
                                 const FrameTiming& timing, const Shutter& shutter) {
    const double interval = timing.step() * shutter.intervals;  // s of the scene, of one step in each interval
    const double end = scene.simulation.duration * (1.0 + 1e-12);
    std::vector<int> steps;
    double time = 0.0;
    std::int64_t at = 0;  // in such intervals
    auto held = std::ranges::find_if(keys, [](const SpeedKeyframe& key) { return key.hold > 0.0; });
    while (time <= end) {
        const double start = time;
        time = next_time(keys, speed, scene.output.fps, start);
        const bool holds = held != keys.end() && held->time <= time;
        if (holds) time = std::max(held->time, start);
        const auto to = std::int64_t(std::llround(time / interval));
        if (time > start || !holds) steps.push_back(int(to - at));
        at = to;
        const double standing = holds ? std::round(held->hold * scene.output.fps) : 0.0;
        if (double(steps.size()) + standing > double(limits::frames))
            throw InputError(fmt::format("[[speed]]: the clip has more than {} frames", limits::frames));
        steps.insert(steps.end(), std::size_t(standing), 0);
        if (holds) held = std::find_if(held + 1, keys.end(), [](const SpeedKeyframe& key) { return key.hold > 0.0; });
    }
    return steps;
}

std::vector<double> frame_times(const SceneDescription& scene) {
    const FrameTiming timing = timing_at_speeds(scene, 1.0, {});
    std::vector<double> times;
    std::int64_t before = 0;
    for (const int steps : steps_of_frames(scene, clip_speed(scene, timing).keys, 1.0, timing, {})) {
        times.push_back(double(before) / (timing.fps * timing.steps_per_frame));
        before += steps;
    }
    return times;
}

}  // namespace tumble
