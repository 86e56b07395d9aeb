// Shapes against the log and the state that they show.
#include "overlay/overlay_builder.h"

#include "scene/load.h"
#include "sim/frames/frame_sequence.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace tumble::overlay_builder_test {
namespace {

constexpr const char* crate_on_ground = R"(
format = 1
[simulation]
duration = 1.0
[materials.wood]
friction = 0.5
restitution = 0.0
[[body]]
name = "ground"
type = "fixed"
shape = { type = "plane" }
material = "wood"
[[body]]
name = "crate"
shape = { type = "box", size = [1, 1, 1] }
mass = 10
material = "wood"
position = [0, 0.5, 0]
)";

SceneDescription scene_showing(const std::string& overlays, const std::string& more = "") {
    return parse_scene(std::string(crate_on_ground) + more + "\n[overlay]\nshow = [" + overlays + "]\n", "test.toml");
}

OverlayScales scales_of_one() {
    OverlayScales scales;
    scales.fill(1.0);
    return scales;
}

/// The shapes after this many frames.
OverlayFrame frame_after(const SceneDescription& scene, int frames) {
    World world(scene);
    world.record_contacts();
    OverlayBuilder builder(scene, scales_of_one());
    OverlayFrame frame = builder.next(world.snapshot(), &world.contact_records());
    for (int n = 0; n < frames; ++n) {
        world.advance_frame();
        frame = builder.next(world.snapshot(), &world.contact_records());
    }
    return frame;
}

TEST(OverlayBuilder, ForcesOfARestingCrateAddUpToItsWeight) {
    const SceneDescription scene = scene_showing("\"forces\", \"contacts\"");
    const OverlayFrame frame = frame_after(scene, 30);
    ASSERT_EQ(frame.arrows.size(), 4u);
    Vec3 sum = Vec3::Zero();
    for (const OverlayArrow& arrow : frame.arrows) sum += arrow.to - arrow.from;
    EXPECT_NEAR(sum.y(), 98.1, 98.1e-9);
    EXPECT_EQ(frame.markers.size(), 4u);
}

TEST(OverlayBuilder, AnArrowStartsAtTheRecordedPointAndHasTheScaledLength) {
    const SceneDescription scene = scene_showing("\"forces\"");
    World world(scene);
    world.record_contacts();
    world.advance_frame();
    OverlayScales scales{};
    scales[std::size_t(ArrowQuantity::force)] = 0.01;
    OverlayBuilder builder(scene, scales);
    const OverlayFrame frame = builder.next(world.snapshot(), &world.contact_records());
    const std::vector<ContactRecord>& contacts = world.contact_records().contacts;
    ASSERT_EQ(frame.arrows.size(), contacts.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        EXPECT_EQ(frame.arrows[i].from, contacts[i].point);
        const Vec3 force = contacts[i].normal_force * contacts[i].normal + contacts[i].tangential_force;
        EXPECT_LT((frame.arrows[i].to - frame.arrows[i].from - 0.01 * force).norm(), 1e-12);
    }
}

TEST(OverlayBuilder, LoadsAreTheWeightAndTheForcesWhileTheyAct) {
    const SceneDescription scene = scene_showing("\"loads\"", R"(
[[force]]
body = "crate"
point = [0.5, 0.5, 0.0]
force = [20, 0, 0]
start = 0.1
end = 0.2
)");
    const OverlayFrame before = frame_after(scene, 5), during = frame_after(scene, 6), after = frame_after(scene, 12);
    ASSERT_EQ(before.arrows.size(), 1u);
    EXPECT_LT((before.arrows[0].to - before.arrows[0].from - Vec3(0, -98.1, 0)).norm(), 1e-12);
    ASSERT_EQ(during.arrows.size(), 2u);
    EXPECT_LT((during.arrows[1].from - Vec3(0.5, 1.0, 0.0)).norm(), 1e-3);
    EXPECT_LT((during.arrows[1].to - during.arrows[1].from - Vec3(20, 0, 0)).norm(), 1e-12);
    EXPECT_EQ(after.arrows.size(), 1u);
}

// The force on the dynamic body is shown, whichever of both comes first in the scene.
TEST(OverlayBuilder, ForcesOnAFixedBodyAreShownOnTheOther) {
    SceneDescription scene = parse_scene(R"(
format = 1
[[body]]
name = "crate"
shape = { type = "box", size = [1, 1, 1] }
position = [0, 0.5, 0]
[[body]]
type = "fixed"
shape = { type = "plane" }
[overlay]
show = ["forces"]
)",
                                         "test.toml");
    for (const OverlayArrow& arrow : frame_after(scene, 10).arrows) EXPECT_GT((arrow.to - arrow.from).y(), 0.0);
}

TEST(OverlayBuilder, MomentaAreThoseOfTheState) {
    SceneDescription scene = scene_showing("\"momentum\", \"angular-momentum\", \"velocity\", \"omega\"", R"(
[[body]]
name = "top"
shape = { type = "box", size = [1, 2, 3] }
mass = 12
position = [0, 9, 0]
velocity = [1, 2, 3]
angular_velocity = [0.5, -1, 2]
)");
    scene.overlay.bodies = {2};
    const OverlayFrame frame = frame_after(scene, 0);
    ASSERT_EQ(frame.arrows.size(), 4u);
    const auto way = [&](std::size_t i) { return Vec3(frame.arrows[i].to - frame.arrows[i].from); };
    EXPECT_LT((way(0) - Vec3(1, 2, 3)).norm(), 1e-14);
    EXPECT_LT((way(1) - Vec3(0.5, -1, 2)).norm(), 1e-14);
    EXPECT_LT((way(2) - Vec3(12, 24, 36)).norm(), 1e-12);
    // m / 12 (b^2 + c^2) and so on: 13, 10, 5 kg m^2
    EXPECT_LT((way(3) - Vec3(0.5 * 13, -1.0 * 10, 2.0 * 5)).norm(), 1e-12);
    EXPECT_FALSE(frame.arrows[2].double_head);
    EXPECT_TRUE(frame.arrows[1].double_head);
    EXPECT_TRUE(frame.arrows[3].double_head);
}

TEST(OverlayBuilder, TheSurveyFindsTheMarksOfContacts) {
    const SceneDescription scene = scene_showing("\"forces\", \"contacts\"", R"(
[[body]]
name = "slider"
shape = { type = "sphere", radius = 0.5 }
material = "wood"
position = [5, 0.5, 0]
velocity = [3, 0, 0]
)");
    World world(scene);
    world.record_contacts();
    ScaleSurvey survey(scene);
    for (int n = 0; n < 5; ++n) {
        world.advance_frame();
        survey.add(world.snapshot(), &world.contact_records());
    }
    const auto bit = [](auto value) { return 1u << unsigned(value); };
    EXPECT_EQ(survey.marks().states, bit(ContactRecord::State::stick) | bit(ContactRecord::State::slip));
    EXPECT_NE(survey.marks().features & bit(ContactFeatures::sphere), 0u);
    EXPECT_EQ(survey.marks().features & bit(ContactFeatures::mesh), 0u);
    EXPECT_TRUE(survey.marks().friction);
}

// Notes eq. 5: p = x + R p_body.
TEST(OverlayBuilder, ATrailFollowsAPointOfTheBody) {
    SceneDescription scene = scene_showing("\"trails\"", R"(
[[body]]
name = "wheel"
shape = { type = "sphere", radius = 1 }
position = [0, 50, 0]
angular_velocity = [0, 0, 3]
)");
    scene.simulation.gravity = Vec3::Zero();
    scene.overlay.trail_points = {{2, {1, 0, 0}}};
    const OverlayFrame frame = frame_after(scene, 60);
    ASSERT_EQ(frame.lines.size(), 1u);
    ASSERT_EQ(frame.lines[0].points.size(), 61u);
    for (std::size_t n = 0; n < 61; ++n) {
        const double angle = 3.0 * double(n) / 60.0;
        EXPECT_LT((frame.lines[0].points[n] - Vec3(std::cos(angle), 50.0 + std::sin(angle), 0)).norm(), 2e-3) << n;
    }
}

TEST(OverlayBuilder, ImpulsesStayVisibleForTheirTime) {
    SceneDescription scene = scene_showing("\"impulses\"", R"(
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
restitution = 1
position = [5, 1.0, 0]
)");
    scene.overlay.bodies = {2};
    scene.overlay.impulse_time = 0.1;
    World world(scene);
    world.record_contacts();
    OverlayBuilder builder(scene, scales_of_one());
    std::vector<double> shown;
    double impact = -1.0;
    for (int n = 0; n < 45; ++n) {
        if (n > 0) world.advance_frame();
        if (!world.contact_records().impacts.empty() && impact < 0.0)
            impact = world.contact_records().impacts[0].when.time;
        if (!builder.next(world.snapshot(), &world.contact_records()).arrows.empty()) shown.push_back(n / 60.0);
    }
    ASSERT_FALSE(shown.empty());
    EXPECT_NEAR(impact, std::sqrt(2.0 * 0.5 / 9.81), 0.02);
    EXPECT_GE(shown.front(), impact);
    EXPECT_LT(shown.front(), impact + 1.0 / 60.0);
    EXPECT_LE(shown.back(), impact + 0.1);
    EXPECT_EQ(shown.size(), 6u);
}

TEST(OverlayBuilder, GhostsAreThePosesOfEveryNthFrame) {
    SceneDescription scene = scene_showing("\"ghosts\"", R"(
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
position = [5, 30, 0]
)");
    scene.overlay.ghost_every = 15;
    const OverlayFrame frame = frame_after(scene, 50);
    std::vector<double> heights;
    for (const OverlaySurface& ghost : frame.surfaces)
        if (ghost.body == 2) heights.push_back(ghost.origin.y());
    ASSERT_EQ(heights.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
        const double t = 0.25 * double(k);
        EXPECT_NEAR(heights[k], 30.0 - 0.5 * 9.81 * t * t, 0.01);
    }
    // The crate rests: its ghost stands where it is.
    EXPECT_TRUE(std::ranges::none_of(frame.surfaces, [](const OverlaySurface& ghost) { return ghost.body == 1; }));
}

TEST(OverlayBuilder, GhostsAreCountedInFramesOfTheClipWithAShutter) {
    SceneDescription scene = scene_showing("\"ghosts\"");
    scene.bodies[1].position.y() = 30.0;
    scene.overlay.ghost_every = 6;
    for (const int intervals : {1, 4}) {
        World world(scene, divided(scene.timing(), intervals), 1);
        FrameSequence sequence(world, {intervals, 1});
        OverlayBuilder builder(scene, scales_of_one());
        OverlayFrame frame;
        for (int n = 0; n <= 20; ++n) frame = builder.next(sequence.next_start(), nullptr);
        EXPECT_EQ(frame.surfaces.size(), 4u) << intervals;
    }
}

TEST(OverlayBuilder, InvisibleBodiesAreShownOnRequestOnly) {
    SceneDescription scene = scene_showing("\"com\"");
    scene.bodies[1].appearance.visible = false;
    EXPECT_TRUE(frame_after(scene, 1).markers.empty());
    scene.overlay.bodies = {0, 1};
    EXPECT_EQ(frame_after(scene, 1).markers.size(), 1u);  // a plane has no center of mass
}

TEST(OverlayBuilder, LongNamesAreCutBetweenCharacters) {
    SceneDescription scene = scene_showing("\"names\"");
    scene.bodies[1].name = "crate";
    EXPECT_EQ(frame_after(scene, 0).labels.at(0).text, "crate");
    std::string characters;
    for (int i = 0; i < 40; ++i) characters += "ω";
    scene.bodies[1].name = characters;
    EXPECT_EQ(frame_after(scene, 0).labels.at(0).text, characters);
    scene.bodies[1].name += "ω";
    EXPECT_EQ(frame_after(scene, 0).labels.at(0).text, characters + "…");
}

TEST(OverlayBuilder, GhostsOfAllBodiesTogetherAreLimited) {
    SceneDescription scene = scene_showing("\"ghosts\"");
    scene.overlay.ghost_every = 1;
    for (int i = 0; i < 500; ++i) {
        scene.bodies.push_back(scene.bodies[1]);
        scene.bodies.back().position.x() = 3.0 * (i + 1);
        scene.bodies.back().velocity.y() = 5.0;
    }
    EXPECT_EQ(frame_after(scene, 2).surfaces.size(), 399u);  // the crate at rest has one as well, which is not drawn
}

TEST(OverlayBuilder, BodiesInContactShareTheColorOfTheirIsland) {
    const SceneDescription scene = scene_showing("\"islands\"", R"(
[[body]]
name = "upper"
shape = { type = "box", size = [1, 1, 1] }
position = [0, 1.5, 0]
[[body]]
name = "other"
shape = { type = "box", size = [1, 1, 1] }
position = [5, 0.5, 0]
)");
    const OverlayFrame frame = frame_after(scene, 5);
    ASSERT_EQ(frame.surfaces.size(), 3u);
    EXPECT_EQ(frame.surfaces[0].paint.color, frame.surfaces[1].paint.color);
    EXPECT_FALSE(frame.surfaces[0].paint.color == frame.surfaces[2].paint.color);
}

TEST(OverlayBuilder, SleepingBodiesAreTinted) {
    const SceneDescription scene = scene_showing("\"sleep\"");
    EXPECT_TRUE(frame_after(scene, 0).surfaces.empty());
    EXPECT_EQ(frame_after(scene, 120).surfaces.size(), 1u);
}

TEST(OverlayBuilder, ShapesAreShownInTheirTimeOnly) {
    SceneDescription scene = scene_showing("\"com\", \"names\"");
    scene.overlay.start = 0.1;
    scene.overlay.end = 0.2;
    EXPECT_TRUE(frame_after(scene, 5).markers.empty());
    EXPECT_EQ(frame_after(scene, 6).markers.size(), 1u);
    EXPECT_EQ(frame_after(scene, 11).labels.size(), 1u);
    EXPECT_TRUE(frame_after(scene, 12).markers.empty());
}

// Slabs across a bar: their faces are squares of its section.
TEST(OverlayBuilder, CracksAreTheFacesBetweenCellsAndOpenWhenPiecesPart) {
    SceneDescription scene = scene_showing("\"cracks\"", R"(
[[body]]
name = "bar"
shape = { type = "box", size = [2.0, 0.1, 0.1] }
density = 1000.0
strength = 1e5
stiffness = 1e9
position = [0.0, 3.0, 0.0]
fracture = { cells = 4, pattern = "slabs", seed = 2 }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.2 }
position = [0.9, 4.0, 0.0]
velocity = [0.0, -8.0, 0.0]
)");
    const auto count = [&](const OverlayFrame& frame, Color color) {
        return std::ranges::count_if(frame.lines, [&](const OverlayLine& line) { return line.paint.color == color; });
    };
    const OverlayFrame whole = frame_after(scene, 0);
    ASSERT_EQ(whole.lines.size(), 3u);
    EXPECT_EQ(count(whole, style::crack_color), 3);
    for (const OverlayLine& line : whole.lines) {
        ASSERT_EQ(line.points.size(), 5u);
        EXPECT_EQ(line.points.front(), line.points.back());
        for (const Vec3& p : line.points) {
            EXPECT_NEAR(std::abs(p.y() - 3.0), 0.05, 1e-6);
            EXPECT_NEAR(std::abs(p.z()), 0.05, 1e-6);
            EXPECT_NEAR(p.x(), line.points[0].x(), 1e-6);
            EXPECT_LT(std::abs(p.x()), 0.99);
        }
    }
    const OverlayFrame broken = frame_after(scene, 30);
    const auto open = count(broken, style::open_crack_color), closed = count(broken, style::crack_color);
    EXPECT_GT(open, 0);
    EXPECT_EQ(open / 2 + closed, 3);  // an open one has the edges of both pieces
    scene.overlay.bodies = {1};       // the crate
    EXPECT_TRUE(frame_after(scene, 30).lines.empty());
}

TEST(OverlayBuilder, AnAabbContainsTheTurnedBodyTightly) {
    SceneDescription scene = scene_showing("\"aabb\"");
    scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(0.25 * 3.14159265358979, Vec3::UnitZ()));
    scene.bodies[1].position = {0, 5, 0};
    const OverlayFrame frame = frame_after(scene, 0);
    ASSERT_EQ(frame.lines.size(), 1u);
    Bounds bounds;
    for (const Vec3& point : frame.lines[0].points) bounds.add(point);
    const double half = std::sqrt(0.5);
    EXPECT_LT((bounds.max - Vec3(half, 5 + half, 0.5)).norm(), 1e-12);
    EXPECT_LT((bounds.min - Vec3(-half, 5 - half, -0.5)).norm(), 1e-12);
}

constexpr const char* hanging_rod = R"(
format = 1
[simulation]
duration = 1.0
[[body]]
name = "rod"
shape = { type = "box", size = [0.1, 1, 0.1] }
mass = 2
position = [0, 1.5, 0]
[[joint]]
type = "hinge"
bodies = ["world", "rod"]
anchor = [0, 2, 0]
axis = [0, 0, 1]
limits = [-90, 45]
[overlay]
show = ["joints"]
)";

TEST(OverlayBuilder, AJointShowsItsForceAxisAndLimits) {
    const SceneDescription scene = parse_scene(hanging_rod, "test.toml");
    EXPECT_TRUE(needs_records(scene.overlay));
    const OverlayFrame frame = frame_after(scene, 2);
    ASSERT_EQ(frame.arrows.size(), 1u);  // no torque
    EXPECT_LT((frame.arrows[0].from - Vec3(0, 2, 0)).norm(), 1e-9);
    EXPECT_LT((frame.arrows[0].to - frame.arrows[0].from - Vec3(0, 2 * 9.81, 0)).norm(), 1e-6);
    ASSERT_EQ(frame.markers.size(), 1u);
    ASSERT_EQ(frame.lines.size(), 3u);
    const Vec3 axis = frame.lines[0].points[1] - frame.lines[0].points[0];
    EXPECT_LT(axis.cross(Vec3::UnitZ()).norm(), 1e-12);
    // The arc spans 135 degrees, and the spoke lies 90 degrees from its lower end.
    const auto direction = [&](const Vec3& p) { return Vec3(p - Vec3(0, 2, 0)).normalized(); };
    const auto& arc = frame.lines[1].points;
    const Vec3 lower = direction(arc[1]), upper = direction(arc[arc.size() - 2]),
               now = direction(frame.lines[2].points[1]);
    EXPECT_NEAR(lower.dot(upper), std::cos(0.75 * std::numbers::pi), 1e-9);
    EXPECT_NEAR(lower.dot(now), 0.0, 1e-6);
    EXPECT_NEAR(upper.dot(now), std::cos(0.25 * std::numbers::pi), 1e-6);
}

TEST(OverlayBuilder, ABrokenJointShowsNothing) {
    std::string text = hanging_rod;
    text.insert(text.find("limits ="), "break_force = 1\n");
    const OverlayFrame frame = frame_after(parse_scene(text, "test.toml"), 2);
    EXPECT_TRUE(frame.arrows.empty() && frame.lines.empty() && frame.markers.empty());
}

}  // namespace
}  // namespace tumble::overlay_builder_test
