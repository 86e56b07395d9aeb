#include "page/frame_channels.h"

#include <gtest/gtest.h>

#include "page/motion_segment.h"
#include "page/prediction.h"

#include <algorithm>
#include <vector>

namespace tumble::frame_channels_test {
namespace {

constexpr double frame_time = 1.0 / 60.0;

std::vector<BodySample> flight(std::size_t count) {
    std::vector<BodySample> samples;
    for (std::size_t n = 0; n < count; ++n) {
        const double t = frame_time * double(n);
        BodySample sample;
        sample.position = {1.0 + 3.0 * t, 2.0 + 4.0 * t - 4.905 * t * t, -0.5 * t};
        sample.velocity = {3.0, 4.0 - 9.81 * t, -0.5};
        sample.angular_velocity = {1.0, -6.0, 2.0};
        sample.rotation = turn_by(t * sample.angular_velocity) * turn_by({0.1, 0.2, 2.9});
        samples.push_back(sample);
    }
    return samples;
}

TEST(FrameChannels, ErrorsAreHalfAQuantumInEachComponent) {
    const Quanta quanta{1e-6, 1e-5, 1e-3, 1e-3};
    const double most = 0.5 * std::sqrt(3.0);
    const FrameChannels channels = encode_frames(flight(3000), quanta, frame_time);
    EXPECT_LE(channels.errors.position, most * quanta.position * (1.0 + 1e-9));
    EXPECT_LE(channels.errors.rotation, most * quanta.rotation * (1.0 + 1e-9));
    EXPECT_LE(channels.errors.velocity, most * quanta.velocity * (1.0 + 1e-9));
    EXPECT_LE(channels.errors.angular_velocity, most * quanta.angular_velocity * (1.0 + 1e-9));
    EXPECT_GT(channels.errors.position, 0.5 * quanta.position);
}

TEST(FrameChannels, AFlightNeedsFewBits) {
    const FrameChannels channels = encode_frames(flight(600), {1e-6, 1e-5, 1e-3, 1e-3}, frame_time);
    std::int64_t large = 0;
    for (const std::int64_t value : channels.values) large += value < -8 || value > 8;
    EXPECT_LE(large, 3 * std::int64_t(channel_count));  // those of the start
}

TEST(FrameChannels, TwoFramesAreEnough) {
    const FrameChannels channels = encode_frames(flight(2), {1e-9, 1e-9, 1e-9, 1e-9}, frame_time);
    EXPECT_LT(channels.errors.position, 1e-9);
    EXPECT_LT(channels.errors.angular_velocity, 1e-9);
}

TEST(Prediction, DifferencesOfTheSmallestOrderAreChosenAndTurnBack) {
    for (const int degree : {0, 1, 2}) {
        std::vector<std::int64_t> given, channel;
        for (std::int64_t i = 0; i < 200; ++i) given.push_back(degree == 0 ? 7 : degree == 1 ? 50 * i : i * i - 3000);
        channel = given;
        const int order = predict(channel);
        EXPECT_EQ(order, degree + 1);
        for (int k = 0; k < order; ++k)
            for (std::size_t i = 1; i < channel.size(); ++i) channel[i] += channel[i - 1];
        EXPECT_EQ(channel, given);
    }
}

}  // namespace
}  // namespace tumble::frame_channels_test
