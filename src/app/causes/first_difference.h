// Where the motions of two records part.
#pragma once

#include "app/causes/motion_record.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

class FirstDifferences {
public:
    FirstDifferences(const PanelRecord& before, const PanelRecord& after);

    /// The first frame in which the body's poses differ, or the first one of its block if the trace has longer ones.
    std::optional<std::int64_t> frame(std::size_t before, std::size_t after) const;
    /// The time (s) of the first contact of the body that is in one record only, or with another impulse.
    std::optional<double> contact(std::size_t before, std::size_t after) const;

    /// " (first differing frame 41, first differing contact at 0.68 s)". Contacts after `seconds` are left out.
    std::string text(std::size_t before, std::size_t after, double seconds) const;

private:
    const PanelRecord &before_, &after_;
    std::size_t count_before_ = 0, count_after_ = 0;         // of bodies that move
    std::vector<std::size_t> moving_before_, moving_after_;  // by body: index among those that move
};

/// The frame of `before` whose poses `after` has at `frame`, if that is another one: +1 is one frame late.
std::optional<std::int64_t> frames_late(const PanelRecord& before, const PanelRecord& after, std::int64_t frame);

}  // namespace tumble
