#include "tumble/frames.h"

#include "sim/frames/frame_sequence.h"

#include "api/convert.h"
#include "api/guard.h"
#include "api/scene_data.h"

#include <fmt/format.h>

namespace tumble::v0 {
namespace {

constexpr int fewest_blur_samples = 2;

/// Throws an Error of the field where the value is outside the range, or not a number.
void check_range(const char* field, double value, double least, double most) {
    if (value >= least && value <= most) return;
    throw Error(ErrorKind::input, {{}, 0, 0, field},
                fmt::format("{} must be from {:g} to {:g} (given {:g})", field, least, most, value));
}

FrameTiming timing_of(const SceneDescription& scene, const ClipTiming& timing) {
    check_range("speed", timing.speed, slowest_speed, fastest_speed);
    check_range("shutter", timing.shutter, 0.0, 360.0);
    check_range("blur_samples", timing.blur_samples, fewest_blur_samples, most_blur_samples);
    return timing_at_speed(scene, timing.speed);
}

}  // namespace

struct FrameSequence::State {
    State(const SceneDescription& scene, const ClipTiming& timing, int threads)
        : frames(timing_of(scene, timing)),
          count(frames.frame_count(scene.simulation.duration)),
          shutter(Shutter::of(timing.shutter, timing.blur_samples)),
          world(scene, divided(frames, shutter.intervals), threads),
          sequence(world, shutter) {}

    FrameTiming frames;
    std::int64_t count, made = 0;
    Shutter shutter;
    tumble::World world;
    tumble::FrameSequence sequence;
};

FrameSequence::FrameSequence(const Scene& scene, const ClipTiming& timing, int threads) {
    guarded([&] {
        check_threads(threads);
        state_ = std::make_unique<State>(*scene.data().description, timing, threads);
    });
}
FrameSequence::~FrameSequence() = default;
FrameSequence::FrameSequence(FrameSequence&&) noexcept = default;
FrameSequence& FrameSequence::operator=(FrameSequence&&) noexcept = default;

std::int64_t FrameSequence::frame_count() const {
    return guarded([&] { return state_of(state_, "FrameSequence").count; });
}

std::vector<Snapshot> FrameSequence::next() {
    return guarded([&] {
        State& state = state_of(state_, "FrameSequence");
        std::vector<Snapshot> moments;
        for (const tumble::Snapshot& moment : state.sequence.next()) {
            moments.push_back(to_public(moment));
            moments.back().frame = state.made;
        }
        ++state.made;
        if (moments.size() > 1) moments.erase(moments.begin());  // when the shutter opens
        return moments;
    });
}

}  // namespace tumble::v0
