// Named causes of planted changes, from records of real runs that went through their files.
#include "app/causes/explain.h"
#include "app/causes/motion_record.h"
#include "app/causes/run_recorder.h"
#include "core/error.h"
#include "scene/load.h"
#include "sim/frames/frame_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace tumble::causes_test {
namespace {

const std::string scene_text = R"(
format = 1
[simulation]
duration = 1.0
[output]
size = [160, 90]
fps = 60
[camera]
eye = [0, 2, 6]
target = [0, 0.5, 0]
[light]
direction = [-0.4, -1.0, -0.3]
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
color = "#808080"
[[body]]
name = "crate"
type = "fixed"
shape = { type = "box", size = [0.5, 0.5, 0.5] }
position = [-1.2, 0.25, 0.0]
color = "#c8853c"
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.2 }
position = [0.6, 1.2, 0.0]
restitution = 0.5
)";

const std::vector<std::int64_t> kept{0, 30, 60};
constexpr std::int64_t frame_count = 61;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::vector<std::pair<Snapshot, ContactRecords>> run_of(const SceneDescription& scene) {
    World world(scene, 1);
    world.record_contacts();
    FrameSequence sequence(world, {1, 1});
    std::vector<std::pair<Snapshot, ContactRecords>> frames;
    for (std::int64_t n = 0; n < frame_count; ++n) {
        Snapshot snapshot = sequence.next_start();
        frames.emplace_back(std::move(snapshot), *sequence.records());
    }
    return frames;
}

/// The record of the scene, through the text of its file. `late`: frames by which each one shows earlier poses.
MotionRecord record_of(const std::string& text, std::int64_t late = 0) {
    const SceneDescription scene = parse_scene(text, "scene.toml");
    const Composition composition(scene);
    RunRecorder recorder(composition, kept, frame_count);
    const auto run = run_of(scene);
    for (std::int64_t n = 0; n < frame_count; ++n) {
        const auto& [snapshot, records] = run[std::size_t(std::max<std::int64_t>(n - late, 0))];
        recorder.panel(0).see(snapshot, {}, &records);
    }
    return parse_record(record_text(recorder.finish()), "r.json");
}

std::vector<std::string> causes_of(const std::string& text, std::int64_t frame) {
    return causes_between(record_of(scene_text), record_of(text), frame, {0, 0, 160, 90});
}

using Texts = std::vector<std::string>;

TEST(Causes, NoneWithoutAChange) {
    for (const std::int64_t frame : kept) EXPECT_EQ(causes_of(scene_text, frame), Texts());
}

// One pixel is 6.2 m * 2 tan(20 degrees) / 90 rows = 0.0501 m at the crate, 6.2 m along the axis from the eye.
TEST(Causes, ABodyThatMovedIsNamedWithItsPixels) {
    const std::string moved = replaced(scene_text, "[-1.2, 0.25, 0.0]", "[-1.05, 0.25, 0.0]");
    EXPECT_EQ(causes_of(moved, 0), Texts{"crate moved by 3 px (first differing frame 0)"});
}

TEST(Causes, ABodyThatTurned) {
    const std::string turned = replaced(scene_text, "position = [-1.2, 0.25, 0.0]",
                                        "position = [-1.2, 0.25, 0.0]\nrotation = { axis = [0, 1, 0], angle = 20 }");
    EXPECT_EQ(causes_of(turned, 0), Texts{"crate turned by 20 degrees (first differing frame 0)"});
}

TEST(Causes, AColor) {
    EXPECT_EQ(causes_of(replaced(scene_text, "#808080", "#828282"), 30), Texts{"color of floor (#808080 to #828282)"});
    EXPECT_EQ(causes_of(replaced(scene_text, "#c8853c", "#c8853e"), 30), Texts{"color of crate (#c8853c to #c8853e)"});
}

TEST(Causes, TheLightAndItsShadows) {
    EXPECT_EQ(causes_of(replaced(scene_text, "[-0.4, -1.0, -0.3]", "[-0.5, -1.0, -0.3]"), 30),
              Texts{"light (direction [-0.3578, -0.8944, -0.2683] to [-0.4319, -0.8639, -0.2592])"});
    EXPECT_EQ(causes_of(replaced(scene_text, "[light]", "[light]\nshadows = false"), 30),
              Texts{"shadow only (shadows are off, they were on)"});
}

TEST(Causes, TheCamera) {
    EXPECT_EQ(causes_of(replaced(scene_text, "eye = [0, 2, 6]", "eye = [0, 2.1, 6]"), 30),
              Texts{"camera (eye moved by 0.1 m)"});
    EXPECT_EQ(causes_of(replaced(scene_text, "eye = [0, 2, 6]", "eye = [0, 2, 6]\nvertical_fov = 41"), 30),
              Texts{"camera (vertical_fov 40 to 41)"});
}

// The ball falls by 1 m: it lands after sqrt(2 / 9.81) = 0.4515 s, in the steps of frame 28.
TEST(Causes, ARestitution) {
    const std::string bouncier = replaced(scene_text, "restitution = 0.5", "restitution = 0.8");
    EXPECT_EQ(causes_of(bouncier, 0), Texts());
    const Texts at_end = causes_of(bouncier, 60);
    ASSERT_EQ(at_end.size(), 2u);
    EXPECT_EQ(at_end[0], "restitution of ball (0.5 to 0.8)");
    EXPECT_TRUE(at_end[1].starts_with("ball moved by ")) << at_end[1];
    EXPECT_TRUE(at_end[1].ends_with(" px (first differing frame 28, first differing contact at 0.45 s)")) << at_end[1];
}

TEST(Causes, GravityIsNamedWhereItMovesABody) {
    const std::string moon = replaced(scene_text, "duration = 1.0", "duration = 1.0\ngravity = [0, -1.6, 0]");
    EXPECT_EQ(causes_of(moon, 0), Texts());
    const Texts later = causes_of(moon, 30);
    ASSERT_EQ(later.size(), 2u);
    EXPECT_EQ(later[0], "gravity ([0, -9.81, 0] to [0, -1.6, 0])");
    EXPECT_TRUE(later[1].starts_with("ball moved by ")) << later[1];
    EXPECT_NE(later[1].find("first differing frame 1,"), std::string::npos) << later[1];
}

TEST(Causes, AFrameThatIsLate) {
    const MotionRecord reference = record_of(scene_text);
    EXPECT_EQ(causes_between(reference, record_of(scene_text, 1), 30, {}),
              Texts{"one frame late (it shows frame 29 of the reference)"});
    EXPECT_EQ(causes_between(record_of(scene_text, 2), reference, 30, {}),
              Texts{"2 frames early (it shows frame 32 of the reference)"});
}

TEST(Causes, ABodyThatIsMissingOrNew) {
    const std::string more = scene_text +
                             "[[body]]\nname = \"cone\"\ntype = \"fixed\"\n"
                             "shape = { type = \"sphere\", radius = 0.3 }\nposition = [0, 0.3, 1]\n";
    EXPECT_EQ(causes_of(more, 0), Texts{"cone is new"});
    EXPECT_EQ(causes_between(record_of(more), record_of(scene_text), 0, {}), Texts{"cone is missing"});
}

TEST(Causes, TextAndSize) {
    const std::string captioned = scene_text + "[[caption]]\ntext = \"Hello\"\n";
    // Captions are a part of the composition that make_composition() fills in.
    const SceneDescription scene = parse_scene(captioned, "scene.toml");
    Composition composition(scene);
    composition.text.title = "Hello";
    RunRecorder recorder(composition, kept, frame_count);
    for (const auto& [snapshot, records] : run_of(scene)) recorder.panel(0).see(snapshot, {}, &records);
    EXPECT_EQ(causes_between(record_of(scene_text), recorder.finish(), 30, {}), Texts{"text (title: none to Hello)"});
    EXPECT_EQ(causes_of(replaced(scene_text, "[160, 90]", "[320, 180]"), 0), Texts{"size (160 x 90 to 320 x 180)"});
}

// The crate is left of the middle, the ball right of it: two changes, of which the image shows one.
TEST(Causes, OnlyThoseInTheChangedPart) {
    const std::string both = replaced(replaced(scene_text, "[-1.2, 0.25, 0.0]", "[-1.05, 0.25, 0.0]"),
                                      "position = [0.6, 1.2, 0.0]", "position = [0.6, 1.2, 0.0]\ncolor = \"#ff0000\"");
    const MotionRecord before = record_of(scene_text), after = record_of(both);
    EXPECT_EQ(causes_between(before, after, 0, {0, 0, 160, 90}).size(), 2u);
    EXPECT_EQ(causes_between(before, after, 0, {0, 0, 80, 90}), Texts{"crate moved by 3 px (first differing frame 0)"});
    EXPECT_EQ(causes_between(before, after, 0, {80, 0, 80, 90}), Texts{"color of ball (#cf9a5b to #ff0000)"});
}

// 40 spheres in a row that all move: three are named, the others counted.
TEST(Causes, FewOfMany) {
    std::string row = scene_text;
    for (int i = 0; i < 40; ++i)
        row += "[[body]]\nname = \"s" + std::to_string(i) + "\"\ntype = \"fixed\"\ncolor = \"#101010\"\n" +
               "shape = { type = \"sphere\", radius = 0.05 }\nposition = [" + std::to_string(-1.0 + 0.05 * i) +
               ", 0.1, 1]\n";
    std::string lighter = row;
    for (std::size_t at; (at = lighter.find("#101010")) != std::string::npos;) lighter.replace(at, 7, "#202020");
    EXPECT_EQ(causes_between(record_of(row), record_of(lighter), 0, {}),
              Texts{"color of s0, s1, s2 and 37 others (#101010 to #202020)"});
    std::string moved = row;
    for (std::size_t at; (at = moved.find(", 0.1, 1]")) != std::string::npos;) moved.replace(at, 9, ", 0.3, 1]");
    const Texts moves = causes_between(record_of(row), record_of(moved), 0, {});
    ASSERT_EQ(moves.size(), 5u);
    EXPECT_EQ(moves.back(), "and 36 more");
}

TEST(Causes, ARecordIsSmall) {
    const std::string text = record_text(record_of(scene_text));
    EXPECT_LT(text.size(), 4000u);
}

TEST(Causes, ADamagedRecordIsAnInputError) {
    const std::string text = record_text(record_of(scene_text));
    EXPECT_THROW(parse_record("", "r.json"), InputError);
    EXPECT_THROW(parse_record("{}", "r.json"), InputError);
    EXPECT_THROW(parse_record(replaced(text, "\"motion_record\":1", "\"motion_record\":2"), "r.json"), InputError);
    EXPECT_THROW(parse_record(replaced(text, "\"frames\":[0,30,60]", "\"frames\":[0,30,60,61]"), "r.json"), InputError);
    EXPECT_THROW(parse_record(replaced(text, "[\"ball\",2,true]", "[\"ball\",9,true]"), "r.json"), InputError);
    EXPECT_THROW(parse_record(replaced(text, "\"every\":1", "\"every\":0"), "r.json"), InputError);
    // Each cut either fails or reads as the whole: the last character is a line break.
    for (std::size_t length = 1; length + 1 < text.size(); length += 7)
        EXPECT_THROW(parse_record(text.substr(0, length), "r.json"), InputError) << length;
}

}  // namespace
}  // namespace tumble::causes_test
