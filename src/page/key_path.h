// The motion of a body as few moments between which it is a MotionSegment: its impacts, and as many frames as a
// tolerance needs. A bouncing ball needs its impacts only.
#pragma once

#include "page/frame_channels.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

struct KeyPath {
    std::vector<std::size_t> frames;  // that are keys, ascending; the first and the last frame are
    MotionErrors errors;              // at the frames between
};

/// Largest deviations of the segments at frames.
inline constexpr MotionErrors page_key_tolerance{2e-7, 2e-6, 1e-5, 1e-4};

struct KeySearch {
    double fps = 60.0;
    Mat3 inertia = Mat3::Zero();  // kg m^2, body frame; zero of bodies that are not dynamic
    std::size_t most = SIZE_MAX;  // keys
};

/// Nothing where the motion needs more than the most keys. Precondition: all events of the body are known; it has at
/// least two samples.
std::optional<KeyPath> find_keys(const BodyRecord& body, const KeySearch& search);

}  // namespace tumble
