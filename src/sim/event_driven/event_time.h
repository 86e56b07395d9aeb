// A time between two steps: whole steps are counted, and only the remainder is a floating-point number of seconds.
// After an hour of a clip an impact's time is so known to 1e-18 s instead of 1e-12.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

namespace tumble {

struct EventTime {
    std::int64_t step = 0;
    double offset = 0.0;  // s after the start of that step; may exceed the length of a step

    friend auto operator<=>(const EventTime&, const EventTime&) = default;
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [step, offset] = self;
        archive.between(0, step, last_step);
        archive.keep(offset);
    }
    static constexpr std::int64_t last_step = std::numeric_limits<std::int64_t>::max() / 4;  // sums do not overflow
};

/// Later than the end of any clip.
inline constexpr EventTime never{EventTime::last_step, 0.0};

/// The length of a step, as the two given whole numbers.
struct StepClock {
    double fps = 60.0;
    int steps_per_frame = 1;

    double seconds(std::int64_t steps) const { return double(steps) / (fps * steps_per_frame); }
    /// b - a, s.
    double between(const EventTime& a, const EventTime& b) const {
        return (a.step == b.step ? 0.0 : seconds(b.step - a.step)) + (b.offset - a.offset);
    }
    double seconds(const EventTime& m) const { return seconds(m.step) + m.offset; }
};

}  // namespace tumble
