// The memory of pictures is known in advance; a run that does not fit is refused or uses fewer processes.
#include "app/workers/frame_memory.h"
#include "core/error.h"

#include <gtest/gtest.h>

namespace tumble::frame_memory_test {
namespace {

constexpr std::uint64_t gibi = std::uint64_t(1) << 30;

SceneDescription scene_of(int width, int height) {
    SceneDescription scene;
    scene.output.width = width;
    scene.output.height = height;
    return scene;
}

RenderWork clip_of(std::int64_t frames) {
    RenderWork work;
    work.outputs.video = PixelFormat::yuv420;
    work.clip = VideoKind::h264;
    work.frames = frames;
    return work;
}

TEST(FrameMemory, GrowsWithTheRequestedOutputs) {
    const SceneDescription scene = scene_of(1000, 1000);
    constexpr std::uint64_t pixels = 1'000'000;
    RenderWork work;
    work.outputs.png = true;
    EXPECT_EQ(render_memory(scene, work).worker, 30 * pixels);
    EXPECT_EQ(render_memory(scene, work).encoder, 0u);
    work.blur_samples = 8;
    EXPECT_EQ(render_memory(scene, work).worker, 46 * pixels);
    EXPECT_EQ(render_memory(scene, clip_of(1)).worker, 33 * pixels);
    EXPECT_EQ(render_memory(scene, clip_of(100)).worker, 37.5 * pixels);
    EXPECT_EQ(render_memory(scene, clip_of(100)).encoder, 25 * pixels);
    SceneDescription with_cord = scene;
    with_cord.cords.emplace_back();
    EXPECT_EQ(render_memory(with_cord, RenderWork{work.outputs, {}, 1, 1}).worker, (64 + 4 + 4 + 10) * pixels);
    RenderWork depth;
    depth.outputs.aovs.add(Aov::depth);
    EXPECT_EQ(render_memory(scene, depth).worker, (16 + 2 * 4) * pixels);
}

TEST(FrameMemory, FewerProcessesDrawIfNotAllFit) {
    const SceneDescription scene = scene_of(8192, 8192);  // 2.34 GiB per worker, 1.56 GiB for ffmpeg
    const AvailableMemory all{64 * gibi, "the machine"};
    EXPECT_EQ(workers_that_fit(scene, clip_of(100), 6, all, all), 6);
    EXPECT_EQ(workers_that_fit(scene, clip_of(100), 6, all, {10 * gibi, "the machine"}), 3);
    EXPECT_EQ(workers_that_fit(scene, clip_of(100), 6, all, {4 * gibi, "the machine"}), 1);
    EXPECT_EQ(workers_that_fit(scene, clip_of(100), 6, {3 * gibi, "ulimit"}, all), 6)
        << "a process's limit holds for each";
}

TEST(FrameMemory, ARunThatDoesNotFitIsRefused) {
    const SceneDescription scene = scene_of(8192, 8192);
    const AvailableMemory all{64 * gibi, "the machine"}, little{2 * gibi, "the machine"};
    EXPECT_THROW(workers_that_fit(scene, clip_of(100), 6, little, all), RunError);
    EXPECT_THROW(workers_that_fit(scene, clip_of(100), 1, all, {3 * gibi, "the machine"}), RunError);
    EXPECT_EQ(workers_that_fit(scene_of(1280, 720), clip_of(100), 8, little, little), 8);
}

}  // namespace
}  // namespace tumble::frame_memory_test
