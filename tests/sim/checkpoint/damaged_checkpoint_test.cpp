// States with wrong values in their places: each is refused by an InputError, or goes on until it ends or fails with a
// RunError. The fuzz target of checkpoints tries many more.
#include "core/error.h"
#include "fuzz/checkpoint_scenes.h"
#include "scene/load.h"
#include "sim/checkpoint/archive.h"
#include "sim/random_shapes.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace tumble::damaged_checkpoint_test {
using namespace tumble::testing;

namespace {

using Bytes = std::vector<std::byte>;

struct Outcomes {
    int refused = 0, went_on = 0;
};

void go_on(const SceneDescription& scene, bool records, const Bytes& bytes, Outcomes& outcomes) {
    World world(scene);
    if (records) world.record_contacts();
    try {
        CheckpointReader reader(bytes);
        world.restore(reader);
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("the checkpoint"), std::string::npos);
        ++outcomes.refused;
        return;
    }
    ++outcomes.went_on;
    try {
        world.advance_frame();
    } catch (const RunError&) {
    }
}

Bytes state_of(const SceneDescription& scene, bool records, int frames) {
    World world(scene);
    if (records) world.record_contacts();
    for (int n = 0; n < frames; ++n) world.advance_frame();
    CheckpointWriter writer;
    world.save(writer);
    return {writer.bytes().begin(), writer.bytes().end()};
}

}  // namespace

TEST(DamagedCheckpoint, WrongValuesAreRefusedOrDoNoHarm) {
    const std::uint32_t wrong[] = {0, 1, 3, 255, 0x7fffffff, 0x80000000, 0xffffffff, 0x7ff00000};
    Outcomes all;
    for (const CheckpointScene& one : checkpoint_scenes) {
        SceneDescription scene = parse_scene(one.text, "scene.toml");
        scene.simulation.steps_per_frame = 2;
        Random random(3);
        for (const int frames : {0, 40}) {
            const Bytes state = state_of(scene, one.records, frames);
            for (int n = 0; n < 150; ++n) {
                Bytes bytes = state;
                const auto at = std::size_t(random.below(int(state.size() - sizeof(std::uint32_t))));
                std::memcpy(bytes.data() + at, &wrong[std::size_t(n) % std::size(wrong)], sizeof(std::uint32_t));
                go_on(scene, one.records, bytes, all);
            }
        }
    }
    EXPECT_GT(all.refused, 200);
    EXPECT_GT(all.went_on, 200);
}

// A count that no file of this length can hold.
TEST(DamagedCheckpoint, LengthsAskForNoMemory) {
    for (const std::uint64_t count : {std::uint64_t(1) << 40, std::numeric_limits<std::uint64_t>::max()}) {
        CheckpointWriter writer;
        writer.any(count);
        writer.keep(std::vector<double>(100, 1.0));
        std::vector<std::vector<double>> lists;
        std::vector<double> numbers;
        EXPECT_THROW(CheckpointReader(writer.bytes()).keep(lists), InputError);
        EXPECT_THROW(CheckpointReader(writer.bytes()).keep(numbers), InputError);
    }
}

TEST(DamagedCheckpoint, ValuesBeyondTheirBoundsAreRefused) {
    CheckpointWriter writer;
    writer.any(std::uint32_t(4));
    const auto read = [&](auto&& action) {
        CheckpointReader reader(writer.bytes());
        reader.expect_bodies(4);
        action(reader);
    };
    enum class Kind : std::uint32_t { first, second, third, fourth };
    std::uint32_t number = 0;
    Kind kind = Kind::first;
    EXPECT_THROW(read([&](auto& archive) { archive.body(number); }), InputError);
    EXPECT_THROW(read([&](auto& archive) { archive.between(0, number, 3); }), InputError);
    EXPECT_THROW(read([&](auto& archive) { archive.enumeration(kind, Kind::fourth); }), InputError);
    EXPECT_NO_THROW(read([&](auto& archive) { archive.between(4, number, 4); }));
    EXPECT_NO_THROW(read([&](auto& archive) { archive.body_or(4u, number); }));

    for (const double value : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        CheckpointWriter numbers;
        numbers.keep(value);
        double back = 0.0;
        EXPECT_THROW(CheckpointReader(numbers.bytes()).keep(back), InputError);
        const auto read_unbounded = [&] { CheckpointReader(numbers.bytes()).unbounded(back); };
        if (std::isnan(value))
            EXPECT_THROW(read_unbounded(), InputError);
        else
            EXPECT_NO_THROW(read_unbounded());
    }
}

}  // namespace tumble::damaged_checkpoint_test
