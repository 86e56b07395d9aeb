// The bytes of a clip: header, determinism, and the sizes that they are allowed.
#include "page/clip_data.h"

#include <gtest/gtest.h>

#include "app/page/record_run.h"
#include "page/array_store.h"
#include "support/scenes.h"

#include <zlib.h>

#include <array>
#include <string>
#include <vector>

namespace tumble::clip_data_test {
namespace {

PageClip clip_of(const SceneDescription& scene, int threads = 1) {
    Interrupt interrupt;
    PageClip clip{"A title with \"quotes\" </script>", "test", {{"scene.toml", "format = 1"}}, {}};
    RecordSettings settings;
    settings.threads = threads;
    settings.label = "only";
    clip.runs.push_back(record_run(scene, settings, interrupt));
    return clip;
}

SceneDescription few_boxes() {
    SceneDescription scene = testing::ground_scene(0.3, 0.4);
    for (int i = 0; i < 6; ++i)
        testing::add_box(scene, {0.4, 0.3, 0.5}, {0.1 * i, 1.0 + 0.7 * i, 0.05 * i}).angular_velocity = {1.0, i * 2.0,
                                                                                                         3.0};
    scene.simulation.duration = 1.5;
    scene.camera.eye = {0.0, 2.0, 8.0};
    scene.camera.target = Vec3::Zero();
    return scene;
}

nlohmann::json header_of(const ClipData& data) {
    std::vector<unsigned char> bytes(10'000'000);
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, -15), Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(data.bytes.data()));
    stream.avail_in = uInt(data.bytes.size());
    stream.next_out = bytes.data();
    stream.avail_out = uInt(bytes.size());
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    inflateEnd(&stream);
    const std::size_t length = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | std::size_t(bytes[3]) << 24;
    return nlohmann::json::parse(bytes.begin() + 4, bytes.begin() + 4 + std::ptrdiff_t(length));
}

TEST(ClipData, TheHeaderHasTheRunAndItsSources) {
    const ClipData data = make_clip_data(clip_of(few_boxes()));
    const nlohmann::json header = header_of(data);
    EXPECT_EQ(header["title"], "A title with \"quotes\" </script>");
    EXPECT_EQ(header["sources"][0]["text"], "format = 1");
    EXPECT_EQ(header["runs"][0]["frames"], 91);
    EXPECT_EQ(header["runs"][0]["label"], "only");
    EXPECT_EQ(header["runs"][0]["bodies"].size(), 7u);
    EXPECT_EQ(header["runs"][0]["motion"]["still"]["bodies"], nlohmann::json::array({0}));
}

TEST(ClipData, BytesAreTheSameForAnyNumberOfThreads) {
    EXPECT_EQ(make_clip_data(clip_of(few_boxes(), 1)).bytes, make_clip_data(clip_of(few_boxes(), 3)).bytes);
}

TEST(ClipData, ASmallerBudgetGivesLargerErrorsWithinTheirLimits) {
    PageClip clip = clip_of(few_boxes());
    const ClipData fine = make_clip_data(clip);
    clip.motion_budget = 0;
    const ClipData coarse = make_clip_data(clip);
    EXPECT_LT(coarse.bytes.size(), fine.bytes.size());
    EXPECT_LT(fine.errors.position, 1e-9);
    EXPECT_GT(coarse.errors.position, 1e-7);
    EXPECT_LE(coarse.errors.position, 1e-6);
    EXPECT_LE(coarse.errors.rotation, 1e-5);
}

TEST(ArrayStore, NumbersAreStoredByPlanesOfTheirBytes) {
    ArrayStore arrays;
    const std::vector<std::int64_t> whole{0, -1, 1, 200, -70000};
    EXPECT_EQ(arrays.add(whole), ArrayStore::Json::array({0, 5, 3}));
    std::vector<std::int64_t> found;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::uint64_t code = 0;
        for (std::size_t plane = 0; plane < 3; ++plane)
            code |= std::uint64_t(arrays.bytes()[plane * whole.size() + i]) << (8 * plane);
        found.push_back(std::int64_t(code >> 1) ^ -std::int64_t(code & 1));
    }
    EXPECT_EQ(found, whole);
    EXPECT_EQ(arrays.add(std::array{1.0, 2.0}), ArrayStore::Json::array({15, 2, 0}));
    EXPECT_EQ(arrays.bytes().size(), 15u + 16u);
}

TEST(ArrayStore, AMantissaIsRoundedToTheNearest) {
    for (const double value : {0.1, -123.456, 1e-300, 0.0, 1.9999999999})
        EXPECT_LE(std::abs(rounded_mantissa(value, 20) - value), std::abs(value) * 0x1p-21 * 1.0001);
    EXPECT_EQ(rounded_mantissa(0.1, 52), 0.1);
    EXPECT_EQ(rounded_mantissa(infinity, 20), infinity);
}

}  // namespace
}  // namespace tumble::clip_data_test
