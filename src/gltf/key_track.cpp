#include "gltf/key_track.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr std::size_t most_samples = 256;          // in a segment: bounds the time, which grows with their square
constexpr std::size_t most_steady_samples = 8192;  // in a segment of one cubic: bounds the memory
constexpr double steady_fraction = 0.1;  // of the tolerance; leaves room for an impact's time in single precision

/// The cubic of glTF between two keys, `u` in 0..1 of `span` s.
template <class Value>
Value cubic(const Value& a, const Value& out, const Value& in, const Value& b, double u, double span) {
    const double v = 1.0 - u;
    return v * v * (1.0 + 2.0 * u) * a + span * u * v * v * out + u * u * (3.0 - 2.0 * u) * b - span * u * u * v * in;
}

/// Distance of positions in m, or angle between rotations in rad.
template <int N>
double deviation(const Eigen::Matrix<double, N, 1>& a, const Eigen::Matrix<double, N, 1>& b) {
    if constexpr (N == 3) return (a - b).norm();
    return 2.0 * (a.normalized() - b).norm();  // of small angles
}

/// Derivative at the first of three samples, of the parabola through them.
template <int N>
Eigen::Matrix<double, N, 1> slope(const KeySample<N>& a, const KeySample<N>& b, const KeySample<N>& c) {
    const double to_b = b.time - a.time, to_c = c.time - a.time;
    return ((b.value - a.value) * (to_c / to_b) - (c.value - a.value) * (to_b / to_c)) / (to_c - to_b);
}

}  // namespace

template <int N>
void KeyTrack<N>::add(const KeySample<N>& sample) {
    if (kind_ == KeyKind::linear) return add_linear(sample);
    if (!started_) {
        started_ = true;
        start_ = sample;
        keys_.push_back(Key::of(sample.time, sample.value));
        return;
    }
    if (still_ && sample.value == start_.value && !sample.corner) {
        samples_.back() = sample;
        return;
    }
    const bool full = samples_.size() >= (steady_ ? most_steady_samples : most_samples);
    const bool stops = !samples_.empty() && sample.value == samples_.back().value;
    if (full || stops || still_) close();
    still_ = samples_.empty() && sample.value == start_.value;
    samples_.push_back(sample);
    std::optional<Tangents> tangents = fit();
    if (!tangents) {
        samples_.pop_back();
        close();
        still_ = sample.value == start_.value;
        samples_.push_back(sample);
        tangents = fit();
    }
    tangents_ = *tangents;
    if (sample.corner) close();
}

/// Only the first and the last of equal values in a row become keys.
template <int N>
void KeyTrack<N>::add_linear(const KeySample<N>& sample) {
    const Value moved = (double(float(sample.time)) - sample.time) * sample.in;  // until the rounded time
    const Key key = Key::of(sample.time, sample.value + moved);
    error_ = std::max(error_, deviation<N>(key.value.template cast<double>() - moved, sample.value));
    if (ends_equal() && keys_.back().value == key.value) keys_.pop_back();
    keys_.push_back(key);
}

template <int N>
bool KeyTrack<N>::ends_equal() const {
    return keys_.size() >= 2 && keys_.back().value == keys_[keys_.size() - 2].value;
}

/// Tangents with which the segment passes all its samples; a single interval always has some.
template <int N>
std::optional<typename KeyTrack<N>::Tangents> KeyTrack<N>::fit() {
    steady_ = false;
    if (still_) return Tangents{Value::Zero(), Value::Zero()};
    const KeySample<N>& end = samples_.back();
    const double span = end.time - start_.time;
    const Value chord = (end.value - start_.value) / span;
    const bool usable = velocities_ || (start_.corner && end.corner);
    if (samples_.size() == 1) {
        // Velocities that contradict the chord: an impact at an unknown time between the two.
        const double off = span * (0.5 * (start_.out + end.in) - chord).norm();
        return usable && off <= tolerance_ ? Tangents{start_.out, end.in} : Tangents{chord, chord};
    }
    if (usable) {
        const Tangents tangents{start_.out, end.in};
        steady_ = continues(tangents);
        if (steady_ || fits(tangents)) return tangents;
    }
    const Tangents tangents = differences();
    if (fits(tangents)) return tangents;
    return {};
}

template <int N>
bool KeyTrack<N>::fits(const Tangents& tangents) const {
    return std::all_of(samples_.rbegin() + 1, samples_.rend(),
                       [&](const KeySample<N>& sample) { return passes(tangents, sample, tolerance_); });
}

/// True if the segment's cubic is nearly the cubic of the segment without its last sample, which passes all others:
/// both begin alike, and pass samples in all parts of the segment closely.
template <int N>
bool KeyTrack<N>::continues(const Tangents& tangents) const {
    constexpr std::size_t least = 8;
    const std::size_t n = samples_.size();
    const double tolerance = steady_fraction * tolerance_;
    const auto close_to = [&](std::size_t i) { return passes(tangents, samples_[i], tolerance); };
    return n >= least && tangents_.first == tangents.first && close_to(n / 4) && close_to(n / 2) &&
           close_to(3 * n / 4) && close_to(n - 2);
}

template <int N>
bool KeyTrack<N>::passes(const Tangents& tangents, const KeySample<N>& sample, double tolerance) const {
    const KeySample<N>& end = samples_.back();
    const double span = end.time - start_.time, u = (sample.time - start_.time) / span;
    return deviation<N>(cubic(start_.value, tangents.first, tangents.second, end.value, u, span), sample.value) <=
           tolerance;
}

template <int N>
typename KeyTrack<N>::Tangents KeyTrack<N>::differences() const {
    const std::size_t n = samples_.size();
    const KeySample<N>& before = n > 2 ? samples_[n - 3] : start_;
    return {slope(start_, samples_[0], samples_[1]), slope(samples_[n - 1], samples_[n - 2], before)};
}

template <int N>
void KeyTrack<N>::close() {
    const KeySample<N>& end = samples_.back();
    Key key{float(end.time), tangents_.second.template cast<float>(), {}, Eigen::Matrix<float, N, 1>::Zero()};
    // The value at the rounded time. Corners have rounded times.
    key.value = (end.value + (double(key.time) - end.time) * tangents_.second).template cast<float>();
    keys_.back().out = tangents_.first.template cast<float>();
    keys_.push_back(key);
    measure();
    start_ = end;
    samples_.clear();
    ends_still_ = still_;
    still_ = false;
}

template <int N>
void KeyTrack<N>::measure() {
    const Key &a = keys_[keys_.size() - 2], &b = keys_.back();
    const double span = double(b.time) - double(a.time);
    for (const KeySample<N>& sample : samples_) {
        const double u = std::clamp((sample.time - double(a.time)) / span, 0.0, 1.0);
        const Value value = cubic<Value>(a.value.template cast<double>(), a.out.template cast<double>(),
                                         b.in.template cast<double>(), b.value.template cast<double>(), u, span);
        error_ = std::max(error_, deviation<N>(value, sample.value));
    }
}

template <int N>
void KeyTrack<N>::finish() {
    if (kind_ == KeyKind::linear) {
        if (ends_equal()) keys_.pop_back();
        return;
    }
    if (!samples_.empty()) close();
    if (!ends_still_) return;
    keys_.pop_back();
    keys_.back().out.setZero();
}

template class KeyTrack<3>;
template class KeyTrack<4>;

}  // namespace tumble
