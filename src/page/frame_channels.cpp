#include "page/frame_channels.h"

#include "page/motion_segment.h"
#include "page/prediction.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Wide = Eigen::Matrix<std::int64_t, 3, 1>;

Wide quantized(const Vec3& value, double quantum) {
    return {std::llround(value.x() / quantum), std::llround(value.y() / quantum), std::llround(value.z() / quantum)};
}

Vec3 value_of(const Wide& whole, double quantum) { return quantum * whole.cast<double>(); }

/// A velocity as the player decodes it: snapped to the quantum, so that a body at rest has none.
Vec3 decoded(const Vec3& rate, const Wide& difference, double quantum) {
    return value_of(quantized(rate + value_of(difference, quantum), quantum), quantum);
}

/// Derivative at frame n of the parabola through three frames; `at(i)` is a difference of positions or the like from
/// frame i - 1 to frame i.
template <class Step>
Vec3 rate_at(std::size_t n, std::size_t count, double frame_time, Step&& at) {
    if (count == 2) return at(1) / frame_time;
    if (n == 0) return (1.5 * at(1) - 0.5 * at(2)) / frame_time;
    if (n + 1 == count) return (1.5 * at(n) - 0.5 * at(n - 1)) / frame_time;
    return 0.5 * (at(n) + at(n + 1)) / frame_time;
}

}  // namespace

void MotionErrors::add(const MotionErrors& other) {
    position = std::max(position, other.position);
    rotation = std::max(rotation, other.rotation);
    velocity = std::max(velocity, other.velocity);
    angular_velocity = std::max(angular_velocity, other.angular_velocity);
}

void MotionErrors::add(const BodySample& exact, const BodySample& found) {
    add(MotionErrors{(exact.position - found.position).norm(), angle_between(exact.rotation, found.rotation),
                     (exact.velocity - found.velocity).norm(),
                     (exact.angular_velocity - found.angular_velocity).norm()});
}

FrameChannels encode_frames(std::span<const BodySample> samples, const Quanta& quanta, double frame_time) {
    const std::size_t count = samples.size();
    FrameChannels result;
    result.values.resize(channel_count * count);
    const auto put = [&](std::size_t channel, std::size_t frame, const Wide& whole) {
        for (int c = 0; c < 3; ++c) result.values[(channel + std::size_t(c)) * count + frame] = whole[c];
    };
    std::vector<Vec3> places, turns;  // decoded; turns from the frame before
    std::vector<Quat> rotations;
    Quat rotation = Quat::Identity();
    for (std::size_t n = 0; n < count; ++n) {
        const Wide place = quantized(samples[n].position, quanta.position);
        put(0, n, place);
        places.push_back(value_of(place, quanta.position));
        const Wide turn = quantized(turn_of(samples[n].rotation * rotation.conjugate()), quanta.rotation);
        put(3, n, turn);
        turns.push_back(value_of(turn, quanta.rotation));
        rotation = (turn_by(turns.back()) * rotation).normalized();
        rotations.push_back(rotation);
    }
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3 drift =
            rate_at(n, count, frame_time, [&](std::size_t i) -> Vec3 { return places[i] - places[i - 1]; });
        const Vec3 spin = rate_at(n, count, frame_time, [&](std::size_t i) { return turns[i]; });
        const Wide velocity = quantized(samples[n].velocity - drift, quanta.velocity);
        const Wide turning = quantized(samples[n].angular_velocity - spin, quanta.angular_velocity);
        put(6, n, velocity);
        put(9, n, turning);
        result.errors.add(samples[n], {places[n], rotations[n], decoded(drift, velocity, quanta.velocity),
                                       decoded(spin, turning, quanta.angular_velocity), false});
    }
    for (std::size_t channel = 0; channel < channel_count; ++channel)
        result.orders.push_back(predict(std::span(result.values).subspan(channel * count, count)));
    return result;
}

}  // namespace tumble
