#include "app/checkpoints/frame_record.h"

#include "sim/frames/clip_timing.h"

#include <cstring>
#include <type_traits>
#include <utility>

namespace tumble {
namespace {

/// To the bit: zeros of both signs differ.
template <class Vector>
bool same_bits(const Vector& a, const Vector& b) {
    return std::memcmp(a.data(), b.data(), sizeof(double) * std::size_t(a.size())) == 0;
}

bool same_pose_bits(const BodyState& a, const BodyState& b) {
    return a.absent == b.absent && same_bits(a.origin, b.origin) && same_bits(a.center_of_mass, b.center_of_mass) &&
           same_bits(a.orientation.coeffs(), b.orientation.coeffs());
}

/// The pose of a body; its center of mass is often its origin.
template <class Archive, class State>
void visit_pose(Archive& archive, State& state) {
    bool at_origin = same_bits(state.origin, state.center_of_mass);
    archive.keep(at_origin, state.origin, state.orientation, state.absent);
    if (!at_origin)
        archive.keep(state.center_of_mass);
    else if constexpr (!std::is_const_v<State>)
        state.center_of_mass = state.origin;
}

template <class Archive, class State>
void visit_body(Archive& archive, State& state, MotionDetail detail) {
    if (detail == MotionDetail::states)
        archive.keep(state);
    else
        visit_pose(archive, state);
}

}  // namespace

bool FrameRecorder::differs(const BodyState& a, const BodyState& b) const {
    if (!same_pose_bits(a, b)) return true;
    return detail_ == MotionDetail::states &&
           !(same_bits(a.velocity, b.velocity) && same_bits(a.angular_velocity, b.angular_velocity) &&
             same_bits(a.momentum, b.momentum) && same_bits(a.angular_momentum, b.angular_momentum) &&
             a.mass == b.mass && a.asleep == b.asleep);
}

void FrameRecorder::add(const std::vector<Snapshot>& samples, const ContactRecords* records) {
    if (!begun_) {
        writer_.enumeration(detail_, MotionDetail::states);
        writer_.any(std::uint64_t(samples.front().bodies.size()));
    }
    begun_ = true;
    writer_.any(std::uint64_t(samples.size()));
    for (const Snapshot& sample : samples) add(sample);
    if (detail_ == MotionDetail::poses) return;
    writer_.keep(records != nullptr);
    if (records != nullptr) writer_.keep(*records);
}

void FrameRecorder::add(const Snapshot& snapshot) {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < snapshot.bodies.size(); ++i)
        if (i >= last_.size() || differs(last_[i], snapshot.bodies[i])) changed.push_back(i);
    writer_.any(snapshot.frame);
    writer_.keep(snapshot.time);
    writer_.bodies(changed);
    for (const std::uint32_t i : changed) visit_body(writer_, snapshot.bodies[i], detail_);
    last_ = snapshot.bodies;
}

std::vector<std::byte> FrameRecorder::take() {
    const std::vector<std::byte> bytes(writer_.bytes().begin(), writer_.bytes().end());
    writer_ = {};
    begun_ = false;
    last_.clear();
    return bytes;
}

FrameReader::FrameReader(std::vector<std::byte> bytes, std::size_t bodies) : bytes_(std::move(bytes)), reader_(bytes_) {
    std::uint64_t count = 0;
    reader_.expect_bodies(bodies);
    reader_.enumeration(detail_, MotionDetail::states);
    reader_.between(bodies, count, bodies);
    last_.resize(bodies);
}

RecordedFrame FrameReader::next() {
    RecordedFrame frame;
    std::uint64_t samples = 0;
    reader_.between(1, samples, most_blur_samples);
    for (; samples > 0; --samples) frame.samples.push_back(next_snapshot());
    if (detail_ == MotionDetail::poses) return frame;
    bool recorded = false;
    reader_.keep(recorded);
    if (recorded) reader_.keep(frame.records.emplace());
    return frame;
}

Snapshot FrameReader::next_snapshot() {
    Snapshot snapshot;
    std::vector<std::uint32_t> changed;
    reader_.any(snapshot.frame);
    reader_.keep(snapshot.time);
    reader_.bodies(changed);
    reader_.require([&] { return std::exchange(begun_, true) || changed.size() == last_.size(); });
    for (const std::uint32_t i : changed) visit_body(reader_, last_[i], detail_);
    snapshot.bodies = last_;
    return snapshot;
}

}  // namespace tumble
