// Files of checkpoints: their content is read back, and anything else is refused with its reason.
#include "app/checkpoints/checkpoint_file.h"
#include "core/error.h"
#include "sim/checkpoint/archive.h"
#include "support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tumble::checkpoint_file_test {
using namespace tumble::testing;

namespace {

using Bytes = std::vector<std::byte>;

CheckpointHeader header() {
    CheckpointHeader header;
    header.program = "1.2.3";
    header.kind = "state";
    header.frame = 60;
    header.identity = {{"the size", "640x360"}, {"the values of the scene", "0a1b2c"}};
    return header;
}

/// The state of a ball on the ground and a falling one.
Bytes state() {
    SceneDescription scene = ground_scene(0.5, 0.5);
    add_sphere(scene, 0.5, Vec3(0.0, 0.5, 0.0));
    add_sphere(scene, 0.5, Vec3(0.0, 1.7, 0.0));
    World world(scene);
    run(world, scene, 0.3);
    CheckpointWriter writer;
    world.save(writer);
    return {writer.bytes().begin(), writer.bytes().end()};
}

std::string reason(const Bytes& bytes, const CheckpointHeader& expected = header()) {
    try {
        checkpoint_content("folder/checkpoint_000060.tumble", bytes, expected);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(CheckpointFile, ReadsItsOwnContent) {
    const Bytes content = state();
    EXPECT_GT(content.size(), 1000u);
    EXPECT_EQ(checkpoint_content("file", checkpoint_bytes(header(), content), header()), content);
    EXPECT_TRUE(checkpoint_content("file", checkpoint_bytes(header(), {}), header()).empty());
}

TEST(CheckpointFile, RefusesEveryFlippedByte) {
    const Bytes good = checkpoint_bytes(header(), state());
    ASSERT_EQ(reason(good), "");
    std::size_t refused = 0, tried = 0;
    for (std::size_t i = 0; i < good.size(); ++i)
        for (const int flip : {0xff, 0x01, 0x80}) {
            Bytes bad = good;
            bad[i] ^= std::byte(flip);
            ++tried;
            refused += reason(bad).empty() ? 0 : 1;
        }
    EXPECT_EQ(refused, tried);
}

TEST(CheckpointFile, RefusesEveryOtherLength) {
    const Bytes good = checkpoint_bytes(header(), state());
    for (std::size_t size = 0; size < good.size(); ++size)
        ASSERT_NE(reason(Bytes(good.begin(), good.begin() + std::ptrdiff_t(size))), "") << size;
    Bytes longer = good;
    longer.push_back(std::byte(0));
    EXPECT_NE(reason(longer), "");
}

TEST(CheckpointFile, NamesTheDifference) {
    const Bytes content = state();
    CheckpointHeader other = header();
    other.identity[0].second = "320x180";
    EXPECT_NE(reason(checkpoint_bytes(other, content)).find("the size: 320x180 there, 640x360 here"),
              std::string::npos);
    other = header();
    other.identity[1].second = "ffffff";
    EXPECT_NE(reason(checkpoint_bytes(other, content)).find("the values of the scene"), std::string::npos);
    other = header();
    other.identity.pop_back();
    EXPECT_NE(reason(checkpoint_bytes(other, content)).find("the values of the scene: none there"), std::string::npos);
    other = header();
    other.program = "1.2.2";
    EXPECT_NE(reason(checkpoint_bytes(other, content)).find("of tumble 1.2.2, and this is tumble 1.2.3"),
              std::string::npos);
    other = header();
    other.format = checkpoint_format + 1;
    EXPECT_NE(
        reason(checkpoint_bytes(other, content))
            .find(fmt::format("format {}, and this program reads format {}", checkpoint_format + 1, checkpoint_format)),
        std::string::npos);
    other = header();
    other.frame = 120;
    EXPECT_NE(reason(checkpoint_bytes(other, content)).find("renamed"), std::string::npos);
    EXPECT_NE(reason(Bytes(100)).find("is no checkpoint"), std::string::npos);
    EXPECT_NE(reason(Bytes(100)).find("checkpoint_000060.tumble"), std::string::npos);
}

}  // namespace tumble::checkpoint_file_test
