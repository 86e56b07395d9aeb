// Render processes: the same bytes for any number of them, an error for each that dies, and none left behind.
#include "app/workers/render_pool.h"
#include "app/drawn_frames.h"
#include "app/files/aov_file.h"
#include "core/error.h"
#include "core/image_mean.h"
#include "output/png_writer.h"
#include "output/video_pixels.h"
#include "render/render_switches.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <signal.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string_view>
#include <thread>

namespace tumble::render_pool_test {
namespace {

constexpr FrameOutputs both{PixelFormat::yuv420, true, {}};

SceneDescription two_boxes() {
    SceneDescription scene;
    scene.output.width = 240;
    scene.output.height = 160;
    scene.output.samples = 1;
    scene.camera.eye = {1.0, 3.0, 9.0};
    scene.camera.target = {0.0, 1.5, 0.0};
    for (int i = 0; i < 3; ++i) {
        BodyDescription body;
        if (i == 0)
            body.shape = PlaneShape{};
        else
            body.shape = BoxShape{{1.0, 1.0, 1.0}};
        scene.bodies.push_back(body);
    }
    return scene;
}

/// One box rests; the other moves in frames 0 to 7 and 12 to 14, and rests in between and afterwards.
Snapshot at_frame(std::int64_t n) {
    const std::int64_t moves = n < 8 ? n : n < 12 ? 7 : n < 15 ? n - 4 : 10;
    Snapshot snapshot;
    snapshot.frame = n;
    snapshot.time = double(n) / 60.0;
    snapshot.bodies.resize(3);
    for (BodyState& body : snapshot.bodies) {
        body.origin = {0.0, 0.0, 0.0};
        body.orientation = Quat::Identity();
    }
    snapshot.bodies[1].origin = {-1.0, 0.5, 0.0};
    snapshot.bodies[2].origin = {1.0, 0.5 + 0.3 * double(moves), 0.0};
    return snapshot;
}

MotionBlurFrame sharp(std::int64_t n) { return {n, at_frame(n).time, {{at_frame(n)}}, {}, {}}; }

/// The shutter is open while the box moves to its next place; without movement, all blur samples are the same. The box
/// is elsewhere when the shutter opens, which no image shows.
MotionBlurFrame blurred(std::int64_t n) {
    MotionBlurFrame frame_poses = sharp(n);
    frame_poses.panels[0][0].bodies[2].origin.x() += 0.5;
    const Snapshot next = at_frame(n + 1);
    for (int i = 0; i < 4; ++i) {
        Snapshot between = at_frame(n);
        between.time += double(i) / (4 * 60.0);
        between.bodies[2].origin += i / 3.0 * (next.bodies[2].origin - between.bodies[2].origin);
        frame_poses.panels[0].push_back(between);
    }
    return frame_poses;
}

/// As draw_frames(), of sharp frames.
std::vector<Seen> draw(
    RenderPool& render_pool, const SceneDescription& scene, std::int64_t frames,
    const std::function<void(std::int64_t)>& meanwhile = [](std::int64_t) {},
    const std::function<MotionBlurFrame(std::int64_t)>& frame_poses = sharp, std::int64_t first = 0) {
    const std::size_t bytes = frame_bytes(PixelFormat::yuv420, scene.output.width, scene.output.height);
    return draw_frames(render_pool, bytes, frames, frame_poses, first, meanwhile);
}

TEST(RenderPool, TheNumberOfProcessesChangesNoByte) {
    const SceneDescription scene = two_boxes();
    std::vector<Seen> first;
    for (const int workers : {1, 2, 3}) {
        RenderPool render_pool(scene, {}, both, workers);
        const std::vector<Seen> seen = draw(render_pool, scene, 24);
        ASSERT_EQ(seen.size(), 24u);
        if (first.empty()) first = seen;
        EXPECT_TRUE(seen == first) << workers;
        EXPECT_EQ(render_pool.drawn(), 11);
    }
    for (std::size_t n = 0; n < first.size(); ++n) {
        EXPECT_EQ(first[n].number, std::int64_t(n));
        EXPECT_EQ(first[n].repeated, (n >= 8 && n < 12) || n >= 15) << n;
    }
    EXPECT_NE(first[0].video, first[7].video);
    EXPECT_NE(first[7].png, first[14].png);
}

TEST(RenderPool, AMovingCameraDrawsEveryFrameAlikeInAnyProcess) {
    SceneDescription scene = two_boxes();
    scene.camera.orbit = 360.0;
    for (const bool blur : {false, true}) {
        std::vector<Seen> first;
        for (const int workers : {1, 2}) {
            RenderPool render_pool(scene, {}, both, workers, 4);
            const std::vector<Seen> seen = draw(
                render_pool, scene, 24, [](std::int64_t) {}, blur ? blurred : sharp);
            if (first.empty()) first = seen;
            EXPECT_TRUE(seen == first) << workers;
            EXPECT_EQ(render_pool.drawn(), 24);
        }
        for (std::size_t n = 1; n < first.size(); ++n) {
            EXPECT_FALSE(first[n].repeated) << n;
            EXPECT_NE(first[n].png, first[n - 1].png) << n;
        }
    }
}

// With jitter: a filtered pose depends on all earlier frames of the clip.
TEST(RenderPool, AFrameDoesNotDependOnTheFirstFrame) {
    const SceneDescription scene = two_boxes();
    const auto creeping = [](std::int64_t n) {
        MotionBlurFrame frame_poses = sharp(n);
        frame_poses.panels[0][0].bodies[1].origin.x() += 3e-5 * double(n);  // 0.02 pixels are 0.9e-3 m
        return frame_poses;
    };
    for (const auto& frame_poses : {std::function<MotionBlurFrame(std::int64_t)>(creeping),
                                    std::function<MotionBlurFrame(std::int64_t)>(blurred)}) {
        RenderPool whole(scene, {}, both, 2, 4);
        const std::vector<Seen> all = draw(
            whole, scene, 36, [](std::int64_t) {}, frame_poses);
        for (const std::int64_t first : {1, 7, 10, 20, 35}) {
            RenderPool render_pool(scene, {}, both, 2, 4);
            const std::vector<Seen> seen = draw(
                render_pool, scene, 36, [](std::int64_t) {}, frame_poses, first);
            ASSERT_EQ(seen.size(), std::size_t(36 - first));
            EXPECT_FALSE(seen.front().repeated);
            for (std::size_t i = 0; i < seen.size(); ++i) {
                const Seen& expected = all[i + std::size_t(first)];
                EXPECT_EQ(seen[i].number, expected.number);
                EXPECT_EQ(seen[i].repeated, i > 0 && expected.repeated) << first << ' ' << i;
                EXPECT_TRUE(seen[i].video == expected.video && seen[i].png == expected.png) << first << ' ' << i;
            }
        }
    }
}

AovSet depth_and_motion() {
    AovSet aovs;
    aovs.add(Aov::depth);
    aovs.add(Aov::motion);
    return aovs;
}

/// Frames of which some differ by less than the tolerance of the pose filter.
Snapshot trembling(std::int64_t n) {
    Snapshot snapshot = at_frame(n);
    snapshot.bodies[1].origin.x() += n % 5 == 0 ? 1e-7 : 0.0;
    return snapshot;
}

MotionBlurFrame with_aovs(std::int64_t n) {
    return {n, trembling(n).time, {{trembling(n)}}, {}, AovPoses{trembling(n), trembling(n + 1)}};
}

TEST(RenderPool, AovsAreIndependentOfTheNumberOfProcessesAndOfPictures) {
    const SceneDescription scene = two_boxes();
    FrameOutputs with = both, alone;
    with.aovs = alone.aovs = depth_and_motion();
    const auto without_aovs = [](std::int64_t n) {
        return MotionBlurFrame{n, trembling(n).time, {{trembling(n)}}, {}, {}};
    };
    std::vector<Seen> pictures, first;
    {
        RenderPool render_pool(scene, {}, both, 2);
        pictures = draw(
            render_pool, scene, 24, [](std::int64_t) {}, without_aovs);
    }
    for (const int workers : {1, 2, 3}) {
        RenderPool render_pool(scene, {}, with, workers);
        const std::vector<Seen> seen = draw(
            render_pool, scene, 24, [](std::int64_t) {}, with_aovs);
        ASSERT_EQ(seen.size(), 24u);
        if (first.empty()) first = seen;
        EXPECT_TRUE(seen == first) << workers;
        EXPECT_EQ(render_pool.drawn(), 11);

        RenderPool no_pictures(scene, {}, alone, workers);
        const std::vector<Seen> aovs = draw(
            no_pictures, scene, 24, [](std::int64_t) {}, with_aovs);
        ASSERT_EQ(aovs.size(), 24u);
        for (std::size_t n = 0; n < aovs.size(); ++n) EXPECT_TRUE(aovs[n].aovs == first[n].aovs) << n;
        EXPECT_EQ(no_pictures.drawn(), 0);
    }
    AovFile file(scene, depth_and_motion());
    for (std::size_t n = 0; n < first.size(); ++n) {
        EXPECT_TRUE(std::ranges::equal(first[n].aovs, file.make(*with_aovs(std::int64_t(n)).aovs))) << n;
        EXPECT_EQ(first[n].number, pictures[n].number);
        EXPECT_EQ(first[n].repeated, pictures[n].repeated) << n;
        EXPECT_TRUE(first[n].video == pictures[n].video && first[n].png == pictures[n].png) << n;
    }
    // In the pictures nothing moves from frame 15 on, but the AOVs of 20 and 21 differ.
    EXPECT_TRUE(first[20].repeated && first[21].repeated);
    EXPECT_NE(first[20].aovs, first[21].aovs);
    EXPECT_EQ(first[22].aovs, first[23].aovs);
}

// Runs work in a process of its own: this one must not use OpenGL, so that later tests can fork.
int status_of_process(const std::function<int()>& work) {
    const pid_t id = fork();
    if (id == 0) _exit(work());
    int status = -1;
    waitpid(id, &status, 0);
    return status;
}

TEST(RenderPool, AllOutputsShowTheRenderersPicture) {
    const SceneDescription scene = two_boxes();
    RenderPool render_pool(scene, {}, both, 2);
    const std::vector<Seen> seen = draw(render_pool, scene, 16);
    const auto expect = [&] {
        RenderSwitches options;
        options.full_redraw = true;
        Renderer renderer(scene, options);
        PngEncoder png;
        for (const Seen& s : seen) {
            const Image& image = renderer.render(at_frame(s.number));
            const Rectangle whole{0, 0, image.width, image.height};
            VideoPixels pixels(PixelFormat::yuv420, image.width, image.height);
            pixels.update(image, {&whole, 1});
            if (!std::ranges::equal(pixels.bytes(), s.video) || !std::ranges::equal(png.encode(image), s.png)) return 1;
        }
        return 0;
    };
    EXPECT_EQ(status_of_process(expect), 0);
}

TEST(RenderPool, MotionBlurIsTheMeanOfItsMoments) {
    const SceneDescription scene = two_boxes();
    std::vector<Seen> first;
    for (const int workers : {1, 3}) {
        RenderPool render_pool(scene, {}, both, workers, 4);
        const std::vector<Seen> seen = draw(
            render_pool, scene, 20, [](std::int64_t) {}, blurred);
        if (first.empty()) first = seen;
        EXPECT_TRUE(seen == first) << workers;
    }
    // Frames 0 to 6 and 11 to 13 are blurred; the first after them is sharp again, then nothing moves.
    for (std::size_t n = 0; n < first.size(); ++n) EXPECT_EQ(first[n].repeated, (n > 7 && n < 11) || n > 14) << n;
    const auto expect = [&] {
        Renderer renderer(scene);
        PngEncoder png;
        for (const Seen& s : first) {
            ImageMean mean;
            Image expected;
            PanelPoses moments = blurred(s.number).panels[0];
            for (const Snapshot& moment : drawn_moments(moments)) mean.add(renderer.render(moment));
            mean.take(expected);
            if (!std::ranges::equal(png.encode(expected), s.png)) return 1;
        }
        return 0;
    };
    EXPECT_EQ(status_of_process(expect), 0);
}

std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const RunError& error) {
        return error.what();
    }
    return "no error";
}

TEST(RenderPool, ADyingProcessIsReportedWithItsFrame) {
    const SceneDescription scene = two_boxes();
    for (const int workers : {1, 2}) {
        RenderPool render_pool(scene, {}, both, workers);
        const pid_t process = render_pool.processes().back();
        std::int64_t last = -1;
        const std::string error = error_of([&] {
            // An infinite number of moving frames: the run can only end by the error, however the frames are
            // distributed.
            const auto meanwhile = [&](std::int64_t n) {
                if (n == 3) kill(process, SIGKILL);
                last = n;
            };
            draw(render_pool, scene, std::int64_t(1) << 40, meanwhile, [](std::int64_t n) {
                return MotionBlurFrame{n, at_frame(n).time, {{at_frame(n % 8)}}, {}, {}};
            });
        });
        constexpr std::string_view words = "error: cannot draw frame ";
        ASSERT_EQ(error.find(words), 0u) << error;
        EXPECT_NE(error.find("its process ended by signal 9"), std::string::npos) << error;
        EXPECT_LT(last, std::stoll(error.substr(words.size())));  // frames after the lost one are not delivered
    }
}

TEST(RenderPool, OpenGlErrorsAreReported) {
    const SceneDescription scene = two_boxes();
    RenderOptions options;
    options.shader_folder = "/nowhere";
    RenderPool render_pool(scene, options, both, 2);
    const std::string error = error_of([&] { draw(render_pool, scene, 4); });
    EXPECT_EQ(error.find("error: cannot draw frame "), 0u) << error;
    EXPECT_NE(error.find("/nowhere"), std::string::npos) << error;
    EXPECT_EQ(error.find("error:", 1), std::string::npos) << error;
}

TEST(RenderPool, RunReturnsAfterAbandon) {
    const SceneDescription scene = two_boxes();
    RenderPool render_pool(scene, {}, both, 2);
    EXPECT_NE(error_of([&] {
                  draw(render_pool, scene, 15, [&](std::int64_t n) {
                      if (n == 2) render_pool.abandon();
                  });
              }),
              "no error");
}

TEST(RenderPool, LeavesNoProcessBehind) {
    const SceneDescription scene = two_boxes();
    std::vector<pid_t> ids;
    {
        RenderPool unused(scene, {}, both, 2);
        ids = unused.processes();
    }
    {
        RenderPool render_pool(scene, {}, both, 2);
        draw(render_pool, scene, 3);
        for (const pid_t id : render_pool.processes()) ids.push_back(id);
        const ProcessEnd end = render_pool.finish();
        EXPECT_GT(end.cpu_seconds, 0.0);
        EXPECT_GT(end.peak_memory, std::int64_t(1) << 20);
    }
    ASSERT_EQ(ids.size(), 4u);
    for (const pid_t id : ids) EXPECT_EQ(kill(id, 0), -1) << "process " << id << " is there, or was never waited for";
}

}  // namespace
}  // namespace tumble::render_pool_test
