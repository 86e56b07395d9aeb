// Clips of several panels with text: the same bytes for any number of processes, each panel the picture of its scene.
#include "app/composition/make_composition.h"
#include "app/drawn_frames.h"
#include "app/pipeline/pipeline.h"
#include "app/threads/interrupt.h"
#include "output/png_reader.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

namespace tumble::panels_test {
namespace {

constexpr FrameOutputs rgba{PixelFormat::rgba, false, {}};

SceneDescription box_scene(int width, int height) {
    SceneDescription scene;
    scene.output.width = width;
    scene.output.height = height;
    scene.camera.eye = {1.0, 3.0, 9.0};
    scene.camera.target = {0.0, 1.5, 0.0};
    BodyDescription ground, box;
    ground.shape = PlaneShape{};
    ground.type = BodyType::fixed;
    box.shape = BoxShape{{1.0, 1.0, 1.0}};
    box.position = {0.0, 3.0, 0.0};
    scene.bodies = {ground, box};
    return scene;
}

/// The box moves in frames 0 to 5 and rests later.
Snapshot at_frame(std::int64_t n, double speed) {
    Snapshot snapshot;
    snapshot.frame = n;
    snapshot.time = double(n) / 10.0;
    snapshot.bodies.resize(2);
    for (BodyState& body : snapshot.bodies) {
        body.origin = {0.0, 0.0, 0.0};
        body.orientation = Quat::Identity();
    }
    snapshot.bodies[1].origin = {0.0, 0.5 + speed * double(std::min<std::int64_t>(n, 5)), 0.0};
    return snapshot;
}

PanelPoses blurred(std::int64_t n, double speed) {
    PanelPoses moments(3, at_frame(n, speed));
    if (n < 5) moments[2].bodies[1].origin.y() += 0.5 * speed;
    return moments;
}

/// The poses of two panels: the box of the second one is faster.
MotionBlurFrame two(std::int64_t n) { return {n, double(n) / 10.0, {{at_frame(n, 0.1)}, {at_frame(n, 0.3)}}, {}, {}}; }
MotionBlurFrame two_blurred(std::int64_t n) {
    return {n, double(n) / 10.0, {blurred(n, 0.1), blurred(n, 0.3)}, {}, {}};
}

std::shared_ptr<const SceneDescription> shared(SceneDescription scene) {
    return std::make_shared<const SceneDescription>(std::move(scene));
}

/// Two panels side by side; the caption is there from frame 8 to frame 10.
Composition two_panels(bool with_text) {
    SceneDescription scene = box_scene(320, 180);
    if (with_text) scene.overlay.captions.push_back({"A caption", 0.75, 1.05});
    if (with_text) scene.overlay.show.add(Overlay::title);
    const auto first = shared(std::move(scene));
    const std::vector<ClipScene> scenes{{first, "one", {}}, {first, "two", {}}};
    return make_composition(scenes, {});
}

std::vector<Seen> draw(const Composition& composition, int workers,
                       const std::function<MotionBlurFrame(std::int64_t)>& frame_poses, std::int64_t first = 0) {
    RenderPool render_pool(composition, {}, rgba, workers, 2);
    return draw_frames(render_pool, frame_bytes(PixelFormat::rgba, composition.width, composition.height), 16,
                       frame_poses, first);
}

/// The rows of a place in a frame.
std::vector<std::byte> part_of(const Seen& frame, int width, const Rectangle& place) {
    std::vector<std::byte> part;
    for (int y = place.y; y < place.y + place.height; ++y) {
        const std::byte* row = frame.video.data() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(place.x));
        part.insert(part.end(), row, row + 4 * std::size_t(place.width));
    }
    return part;
}

TEST(Panels, TheNumberOfProcessesAndTheFirstFrameChangeNoByte) {
    const Composition composition = two_panels(true);
    for (const auto& frame_poses : {two, two_blurred}) {
        const std::vector<Seen> one = draw(composition, 1, frame_poses);
        ASSERT_EQ(one.size(), 16u);
        EXPECT_TRUE(draw(composition, 3, frame_poses) == one);
        const std::vector<Seen> late = draw(composition, 2, frame_poses, 4);
        ASSERT_EQ(late.size(), 12u);
        for (std::size_t i = 0; i < late.size(); ++i) EXPECT_TRUE(late[i].video == one[i + 4].video) << i;
    }
}

TEST(Panels, OnlyChangesOfPanelsOrTextMakeNewPictures) {
    const std::vector<Seen> frames = draw(two_panels(true), 2, two);
    for (std::size_t n = 1; n < frames.size(); ++n) EXPECT_EQ(frames[n].repeated, n > 5 && n != 8 && n != 11) << n;
    EXPECT_TRUE(frames[7].video == frames[11].video);
}

TEST(Panels, APanelIsThePictureOfItsScene) {
    const Composition composition = two_panels(false);
    ASSERT_FALSE(composition.plain());
    const std::vector<Seen> frames = draw(composition, 2, two);
    for (std::size_t panel = 0; panel < 2; ++panel) {
        const Composition alone(*composition.panels[panel].scene);
        ASSERT_TRUE(alone.plain());
        const std::vector<Seen> expected = draw(alone, 1, [&](std::int64_t n) {
            MotionBlurFrame frame_poses = two(n);
            frame_poses.panels = {frame_poses.panels[panel]};
            return frame_poses;
        });
        for (std::size_t n = 0; n < frames.size(); ++n)
            EXPECT_TRUE(part_of(frames[n], composition.width, composition.panels[panel].place) == expected[n].video)
                << panel << ' ' << n;
    }
}

// Two worlds of 0.5 s and 1 s: frames after the end of the shorter one show its last frame.
TEST(Panels, ASceneThatEndsEarlierKeepsItsLastFrame) {
    SceneDescription scene = box_scene(320, 180);
    scene.output.fps = 10.0;
    const auto falling = shared(scene);
    const std::vector<ClipScene> scenes{{falling, "one", falling->timing()}, {falling, "two", falling->timing()}};
    const Composition composition = make_composition(scenes, {});
    RenderPool render_pool(composition, {}, {std::nullopt, true, {}}, 2);
    World shorter(*falling), longer(*falling);
    const std::vector<PanelSource> sources{{.world = &shorter, .end = 4}, {.world = &longer, .end = 8}};
    FrameFolder folder(std::filesystem::temp_directory_path() / "tumble-panels-test");
    Pipeline pipeline(sources, PipelineFrames::all({0, 8}), render_pool, {&folder, nullptr, nullptr});
    Interrupt interrupt;
    pipeline.run(interrupt, [](std::int64_t) {});
    std::vector<Image> frames;
    for (std::int64_t n = 0; n < 8; ++n) frames.push_back(read_png(frame_path(folder.path(), n)));
    std::filesystem::remove_all(folder.path());
    const auto same = [&](std::size_t a, std::size_t b, const Rectangle& place) {
        for (int y = place.y; y < place.y + place.height; ++y)
            if (std::memcmp(frames[a].at(place.x, y), frames[b].at(place.x, y), 4 * std::size_t(place.width)) != 0)
                return false;
        return true;
    };
    const Rectangle &first = composition.panels[0].place, &second = composition.panels[1].place;
    EXPECT_FALSE(same(2, 3, first));
    for (std::size_t n = 4; n < 8; ++n) EXPECT_TRUE(same(n, 3, first)) << n;
    EXPECT_FALSE(same(4, 3, second));
}

}  // namespace
}  // namespace tumble::panels_test
