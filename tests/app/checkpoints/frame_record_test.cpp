// The motion of frames as bytes: all poses come back to the bit, and each piece stands alone.
#include "app/checkpoints/frame_record.h"
#include "core/error.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <vector>

namespace tumble::frame_record_test {
using namespace tumble::testing;

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t bodies = 4;  // of scene()

template <class... T>
Bytes bytes_of(const T&... values) {
    CheckpointWriter writer;
    writer.keep(values...);
    return {writer.bytes().begin(), writer.bytes().end()};
}

Bytes poses(const Snapshot& snapshot) {
    CheckpointWriter writer;
    writer.any(snapshot.frame);
    writer.keep(snapshot.time);
    for (const BodyState& body : snapshot.bodies) writer.keep(body.origin, body.center_of_mass, body.orientation);
    return {writer.bytes().begin(), writer.bytes().end()};
}

/// A box falls onto another one, beside a ball.
SceneDescription scene() {
    SceneDescription scene = ground_scene(0.3, 0.5, 4);
    add_box(scene, Vec3(1.0, 0.5, 0.5), Vec3(0.1, 1.5, 0.0));
    BodyDescription& lower = add_box(scene, Vec3(1.0, 0.4, 0.4), Vec3(0.0, 0.5, 0.0));
    lower.rotation = turn(Vec3(1.0, 2.0, 0.5), 0.4);
    add_sphere(scene, 0.2, Vec3(0.0, 5.0, 0.0));
    return scene;
}

std::vector<std::vector<Snapshot>> frames_of(World& world, int count) {
    std::vector<std::vector<Snapshot>> frames;
    for (int n = 0; n < count; ++n) {
        frames.push_back({world.snapshot()});
        world.advance_frame();
        frames.back().push_back(world.snapshot());
    }
    // A center of mass beside the origin, as of a mesh; and a body at rest but for the sign of a zero.
    for (auto& samples : frames)
        for (Snapshot& sample : samples) {
            sample.bodies[2].center_of_mass += Vec3(0.1, 0.0, 0.0);
            sample.bodies[3].origin = Vec3(sample.frame % 2 == 0 ? 0.0 : -0.0, 5.0, 0.0);
            sample.bodies[3].center_of_mass = sample.bodies[3].origin;
        }
    return frames;
}

}  // namespace

TEST(FrameRecord, PosesComeBackToTheBit) {
    World world(scene());
    const auto frames = frames_of(world, 40);
    FrameRecorder recorder(MotionDetail::poses);
    std::vector<Bytes> pieces;
    for (std::size_t n = 0; n < frames.size(); ++n) {
        recorder.add(frames[n], nullptr);
        if (n == 12 || n + 1 == frames.size()) pieces.push_back(recorder.take());
    }
    std::size_t n = 13;  // the second piece needs nothing of the first
    for (FrameReader reader(pieces[1], bodies); !reader.at_end(); ++n) {
        const RecordedFrame frame = reader.next();
        ASSERT_EQ(frame.samples.size(), 2u);
        for (std::size_t k = 0; k < 2; ++k) ASSERT_TRUE(poses(frame.samples[k]) == poses(frames[n][k])) << n;
    }
    EXPECT_EQ(n, frames.size());
}

TEST(FrameRecord, StatesComeBackWithTheirRecords) {
    World world(scene());
    world.record_contacts();
    const auto frames = frames_of(world, 40);
    FrameRecorder recorder(MotionDetail::states);
    for (const auto& samples : frames) recorder.add(samples, &world.contact_records());
    FrameReader reader(recorder.take(), bodies);
    for (const auto& samples : frames) {
        const RecordedFrame frame = reader.next();
        ASSERT_TRUE(bytes_of(frame.samples) == bytes_of(samples));
        ASSERT_TRUE(frame.records.has_value());
        ASSERT_TRUE(bytes_of(*frame.records) == bytes_of(world.contact_records()));
    }
    EXPECT_TRUE(reader.at_end());
}

TEST(FrameRecord, BodiesAtRestTakeNoBytes) {
    World world(scene());
    const std::vector<Snapshot> still{world.snapshot()};
    FrameRecorder recorder(MotionDetail::poses);
    recorder.add(still, nullptr);
    const std::size_t one = recorder.take().size();
    for (int n = 0; n < 2; ++n) recorder.add(still, nullptr);
    EXPECT_LE(recorder.take().size(), one + 32);
}

TEST(FrameRecord, OtherBytesAreRefused) {
    World world(scene());
    FrameRecorder recorder(MotionDetail::poses);
    recorder.add({world.snapshot()}, nullptr);
    const Bytes bytes = recorder.take();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const auto read = [&] {
            FrameReader reader(Bytes(bytes.begin(), bytes.begin() + std::ptrdiff_t(size)), bodies);
            reader.next();
        };
        EXPECT_THROW(read(), InputError) << size;
    }
}

}  // namespace tumble::frame_record_test
