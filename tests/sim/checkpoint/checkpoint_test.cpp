// A world restored from the saved state of another goes on as that one does, to the last byte: its state, its records
// of contacts and its energies at each later frame, for every scene of the demos and of the lessons, in all modes.
#include "scene/load.h"
#include "sim/checkpoint/archive.h"
#include "sim/frames/frame_sequence.h"
#include "sim/random_scenes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tumble::checkpoint_test {
using namespace tumble::testing;

namespace {

using Bytes = std::vector<std::byte>;

Bytes saved(const World& world) {
    CheckpointWriter writer;
    world.save(writer);
    return {writer.bytes().begin(), writer.bytes().end()};
}

void restore(const Bytes& bytes, World& world) {
    CheckpointReader reader(bytes);
    world.restore(reader);
    EXPECT_TRUE(reader.at_end());
}

/// The numbers of a frame that users see.
Bytes seen(const World& world) {
    CheckpointWriter writer;
    const Measurement m = world.measure();
    writer.keep(world.snapshot(), m.kinetic, m.potential, m.momentum, m.angular_momentum, m.contacts,
                m.max_penetration);
    if (world.records_contacts()) writer.keep(world.contact_records());
    return {writer.bytes().begin(), writer.bytes().end()};
}

struct Run {
    int frames = 90;
    std::vector<int> saves{0, 13, 45, 77};
    bool records = true;
};

World world_of(const SceneDescription& scene, const Run& run, int threads) {
    World world(scene, threads);
    if (run.records) world.record_contacts();
    return world;
}

/// Restored worlds have another number of threads than the one that wrote.
void expect_goes_on(const SceneDescription& scene, const Run& run = {}) {
    World whole = world_of(scene, run, 1);
    std::vector<Bytes> states, frames;
    for (int n = 0; n <= run.frames; ++n) {
        if (n > 0) whole.advance_frame();
        states.push_back(saved(whole));
        frames.push_back(seen(whole));
    }
    int threads = 1;
    for (const int first : run.saves) {
        threads = 3 - threads;
        World part = world_of(scene, run, threads);
        restore(states[std::size_t(first)], part);
        for (int n = first; n <= run.frames; ++n) {
            if (n > first) part.advance_frame();
            ASSERT_TRUE(seen(part) == frames[std::size_t(n)]) << "frame " << n << " of a part from " << first;
            ASSERT_TRUE(saved(part) == states[std::size_t(n)]) << "state " << n << " of a part from " << first;
        }
    }
}

void expect_folder_goes_on(const std::string& folder, const std::function<void(SceneDescription&)>& change = {},
                           const Run& run = {}) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(TUMBLE_SOURCE_DIR) + folder)) {
        if (entry.path().extension() != ".toml") continue;
        SCOPED_TRACE(entry.path().filename().string());
        SceneDescription scene = load_scene(entry.path());
        Run shorter = run;
        if (scene.bodies.size() > 200) shorter.frames = 8, shorter.saves = {4};
        if (change) change(scene);
        expect_goes_on(scene, shorter);
        ++scenes;
    }
    EXPECT_GT(scenes, 8);
}

}  // namespace

TEST(Checkpoint, DemosGoOn) {
    expect_folder_goes_on("/assets/scenes", {}, {.frames = 60, .saves = {13, 41}, .records = true});
}

TEST(Checkpoint, LessonsGoOn) { expect_folder_goes_on("/assets/scenes/teaching"); }

TEST(Checkpoint, DemosGoOnWithExactImpacts) {
    expect_folder_goes_on("/assets/scenes",
                          [](SceneDescription& scene) {
                              if (scene.bodies.size() < 100) scene.simulation.impacts = ImpactMode::exact;
                          },
                          {.frames = 36, .saves = {14}, .records = true});
}

TEST(Checkpoint, AllIntegratorsGoOn) {
    for (const IntegratorKind kind :
         {IntegratorKind::explicit_euler, IntegratorKind::symplectic_euler, IntegratorKind::splitting,
          IntegratorKind::runge_kutta_4, IntegratorKind::exact}) {
        SCOPED_TRACE(int(kind));
        Random random(7);
        SceneDescription scene = random_scene(random, {.bodies = 14});
        for (BodyDescription& body : scene.bodies) body.integrator = kind;
        expect_goes_on(scene, {.frames = 60, .saves = {1, 30}, .records = true});
    }
}

// Two piles fall asleep; a ball wakes the one, and its boxes the other.
TEST(Checkpoint, SleepGoesOn) {
    SceneDescription scene = ground_scene(0.0, 0.6, 4);
    for (int i = 0; i < 6; ++i) add_box(scene, Vec3::Constant(0.5), Vec3(i < 3 ? 0.0 : 3.0, 0.25 + 0.5 * (i % 3), 0.0));
    BodyDescription& ball = add_sphere(scene, 0.3, Vec3(-14.0, 0.8, 0.0), 4.0);
    ball.velocity = Vec3(7.0, 2.0, 0.0);
    World world(scene);
    for (int n = 0; n < 110; ++n) world.advance_frame();
    EXPECT_TRUE(world.snapshot().bodies[1].asleep && world.snapshot().bodies[4].asleep);
    for (int n = 0; n < 20; ++n) world.advance_frame();
    EXPECT_TRUE(!world.snapshot().bodies[1].asleep && world.snapshot().bodies[4].asleep);
    expect_goes_on(scene, {.frames = 170, .saves = {40, 110, 130}, .records = true});
    scene.simulation.impacts = ImpactMode::exact;
    expect_goes_on(scene, {.frames = 170, .saves = {40, 110, 130}, .records = false});
}

TEST(Checkpoint, RandomScenesGoOn) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SceneDescription scene = random_scene(random, {.bodies = 20, .steps_per_frame = 4});
        if (seed % 2 == 0) scene.simulation.impacts = ImpactMode::exact;
        expect_goes_on(scene, {.frames = 60, .saves = {5, 33}, .records = seed < 4});
    }
}

// A heap of hundreds is solved by all threads together, in blocks.
TEST(Checkpoint, ALargeHeapGoesOn) {
    SceneDescription scene = ground_scene(0.1, 0.5, 4);
    for (int i = 0; i < 700; ++i)
        add_box(scene, Vec3::Constant(0.3), Vec3(0.31 * (i % 7), 0.16 + 0.31 * (i / 49), 0.31 * (i / 7 % 7)));
    expect_goes_on(scene, {.frames = 24, .saves = {6, 15}, .records = false});
}

// A net of ropes falls on a ball: its joints are solved in sweeps.
TEST(Checkpoint, ANetGoesOn) {
    SceneDescription scene = ground_scene(0.0, 0.5, 4);
    const int side = 9;
    for (int i = 0; i < side * side; ++i) add_sphere(scene, 0.1, Vec3(0.3 * (i % side), 1.2, 0.3 * (i / side)));
    add_sphere(scene, 0.5, Vec3(1.2, 0.5, 1.2)).type = BodyType::fixed;
    const auto tie = [&](int a, int b) {
        JointDescription joint;
        joint.name = std::to_string(a) + " " + std::to_string(b);
        joint.type = JointType::distance;
        joint.first = std::size_t(1 + a);
        joint.second = std::size_t(1 + b);
        joint.move[0].motion = JointAxis::Motion::limited;
        joint.move[0].lower = 0.0;
        joint.move[0].upper = 0.3;
        scene.joints.push_back(joint);
    };
    for (int i = 0; i < side * side; ++i) {
        if (i % side > 0) tie(i - 1, i);
        if (i >= side) tie(i - side, i);
    }
    ASSERT_EQ(World(scene).joint_report().swept(), 1u);
    expect_goes_on(scene, {.frames = 48, .saves = {6, 20, 35}, .records = true});
}

// The state of the log is apart: a world without records reads that of a world with records, not the other way round.
TEST(Checkpoint, RecordsMayBeLeftOut) {
    Random random(3);
    const SceneDescription scene = random_scene(random, {.bodies = 10});
    World with = world_of(scene, {.records = true}, 1), without = world_of(scene, {.records = false}, 1);
    for (int n = 0; n < 20; ++n) {
        with.advance_frame();
        without.advance_frame();
    }
    World reads = world_of(scene, {.records = false}, 1);
    restore(saved(with), reads);
    EXPECT_TRUE(saved(reads) == saved(without));
    World asks = world_of(scene, {.records = true}, 1);
    const Bytes bytes = saved(without);
    CheckpointReader reader(bytes);
    EXPECT_THROW(asks.restore(reader), InputError);
}

TEST(Checkpoint, BytesThatEndEarlyAreRefused) {
    Random random(5);
    const SceneDescription scene = random_scene(random, {.bodies = 5});
    World world(scene);
    for (int n = 0; n < 20; ++n) world.advance_frame();
    const Bytes bytes = saved(world);
    for (std::size_t size = 0; size < bytes.size(); size += 97) {
        World fresh(scene);
        CheckpointReader reader(std::span<const std::byte>(bytes).first(size));
        EXPECT_THROW(fresh.restore(reader), InputError) << size;
    }
}

// With a shutter, impacts of the parts of a frame are gathered across them.
TEST(Checkpoint, FramesOfAShutterGoOn) {
    Random random(11);
    const SceneDescription scene = random_scene(random, {.bodies = 12});
    const Shutter shutter = Shutter::of(180.0, 3);
    const FrameTiming timing = divided(scene.timing(), shutter.intervals);
    const auto frame_bytes = [](FrameSequence& frames) {
        CheckpointWriter writer;
        writer.keep(frames.next(), *frames.records());
        return Bytes(writer.bytes().begin(), writer.bytes().end());
    };
    World whole(scene, timing, 1);
    whole.record_contacts();
    FrameSequence frames(whole, shutter);
    Bytes state;
    std::vector<Bytes> later;
    for (int n = 0; n < 60; ++n) {
        if (n == 31) {
            frames.reach_next();
            CheckpointWriter writer;
            whole.save(writer);
            FrameSequence::visit(writer, frames);
            state.assign(writer.bytes().begin(), writer.bytes().end());
        }
        const Bytes bytes = frame_bytes(frames);
        if (n >= 31) later.push_back(bytes);
    }
    World part(scene, timing, 2);
    part.record_contacts();
    FrameSequence goes_on(part, shutter);
    CheckpointReader reader(state);
    part.restore(reader);
    FrameSequence::visit(reader, goes_on);
    for (const Bytes& bytes : later) ASSERT_TRUE(frame_bytes(goes_on) == bytes);
}

}  // namespace tumble::checkpoint_test
