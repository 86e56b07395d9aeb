// The motion of a body as quantized values at each frame.
//
// Positions are multiples of a quantum. A rotation is the decoded one of the frame before, followed by a rotation
// vector of whole quanta: errors do not add up. Velocities are stored less the velocities that follow from the decoded
// positions and rotations: nearly nothing; their sum is snapped to the quantum.
#pragma once

#include "page/page_run.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct Quanta {
    double position = 0.0, rotation = 0.0;          // m, rad
    double velocity = 0.0, angular_velocity = 0.0;  // m/s, rad/s
};

struct MotionErrors {
    double position = 0.0, rotation = 0.0;          // m, rad
    double velocity = 0.0, angular_velocity = 0.0;  // m/s, rad/s
    void add(const MotionErrors& other);
    void add(const BodySample& exact, const BodySample& found);
};

inline constexpr std::size_t channel_count = 12;  // position, rotation, velocity, angular velocity: three each

/// One body: channel after channel, each with all frames.
struct FrameChannels {
    std::vector<std::int64_t> values;
    std::vector<std::int64_t> orders;  // of prediction, by channel
    MotionErrors errors;
};

/// `frame_time`: s between two frames. Precondition: at least two samples.
FrameChannels encode_frames(std::span<const BodySample> samples, const Quanta& quanta, double frame_time);

}  // namespace tumble
