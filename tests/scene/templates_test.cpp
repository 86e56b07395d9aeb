// [template.NAME] and [[instance]]: places, poses by forward kinematics, sizes, and every refusal.
#include "core/deterministic_math.h"
#include "core/error.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace tumble::templates_test {
namespace {

constexpr double exact = 1e-14;

/// An arm along x: a shoulder in the origin, links of 2 m and 1 m, joined at x = 1 and x = 3, a hand that slides along
/// x, and a bead that hangs on a rope.
const std::string arm = R"(format = 1
[template.arm]
[[template.arm.body]]
name = "shoulder"
shape = { type = "sphere", radius = 1 }
density = 3
[[template.arm.body]]
name = "upper"
shape = { type = "box", size = [2, 0.2, 0.2] }
position = [2, 0, 0]
velocity = [1, 0, 0]
[[template.arm.body]]
name = "lower"
shape = { type = "box", size = [1, 0.2, 0.2] }
position = [3.5, 0, 0]
[[template.arm.body]]
name = "hand"
shape = { type = "sphere", radius = 0.1 }
position = [4, 0, 0]
[[template.arm.body]]
name = "bead"
shape = { type = "sphere", radius = 0.1 }
position = [4, -1, 0]
[[template.arm.joint]]
name = "root"
type = "hinge"
bodies = ["shoulder", "upper"]
anchor = [1, 0, 0]
axis = [0, 0, 1]
limits = [-100, 100]
spring = { stiffness = 2, damping = 3, rest = 5 }
motor = { speed = 4, max_torque = 6 }
break_torque = 7
break_force = 8
[[template.arm.joint]]
name = "elbow"
type = "hinge"
bodies = ["lower", "upper"]
anchor = [3, 0, 0]
axis = [0, 1, 0]
[[template.arm.joint]]
name = "grip"
type = "slider"
bodies = ["lower", "hand"]
axis = [1, 0, 0]
limits = [-0.5, 0.5]
spring = { stiffness = 2, damping = 3 }
[[template.arm.joint]]
name = "rope"
type = "distance"
bodies = ["hand", "bead"]
anchors = [[0, 0, 0], [0, 0, 0]]
)";

SceneDescription scene_with(const std::string& lines) {
    return parse_scene(arm + "[[instance]]\ntemplate = \"arm\"\nname = \"a\"\n" + lines, "dir/scene.toml");
}

const BodyDescription& find_body(const SceneDescription& scene, const std::string& name) {
    const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                    [&](const BodyDescription& body) { return body.name == name; });
    if (found == scene.bodies.end()) throw std::runtime_error("no body " + name);
    return *found;
}

Vec3 position_of(const SceneDescription& scene, const std::string& name) { return find_body(scene, name).position; }

void expect_near(const Vec3& a, const Vec3& b, double tolerance = exact) {
    EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " and " << b.transpose();
}

/// Anchors of both sides meet, and frames of sliders agree.
void expect_closed(const SceneDescription& scene, double tolerance = 1e-13) {
    for (const JointDescription& joint : scene.joints) {
        if (joint.type != JointType::hinge) continue;
        const auto anchor = [&](const std::optional<std::size_t>& body, const Vec3& p) {
            return body ? Vec3(scene.bodies[*body].position + scene.bodies[*body].rotation * p) : p;
        };
        expect_near(anchor(joint.first, joint.anchor_first), anchor(joint.second, joint.anchor_second), tolerance);
    }
}

TEST(Templates, AreMovedAndTurned) {
    const SceneDescription scene = scene_with(
        "position = [0, 10, 0]\nrotation = { axis = [0, 1, 0], angle = 90 }\nvelocity = [0, 0, 3]\n"
        "angular_velocity = [0, 2, 0]\n[[force]]\nbody = \"a.hand\"\nforce = [1, 0, 0]\n");
    ASSERT_EQ(scene.bodies.size(), 5u);
    ASSERT_EQ(scene.joints.size(), 4u);
    EXPECT_EQ(scene.joints[1].name, "a.elbow");
    EXPECT_EQ(scene.forces[0].body, 3u);
    expect_near(position_of(scene, "a.hand"), Vec3(0, 10, -4));
    expect_near(find_body(scene, "a.upper").velocity,
                Vec3(-4, 0, 2));  // (0, 0, 3) + (0, 2, 0) x (0, 0, -2) + turned own
    expect_near(find_body(scene, "a.hand").angular_velocity, Vec3(0, 2, 0));
    expect_closed(scene);
}

TEST(Templates, ArePosedFromTheFirstBodyOutward) {
    const SceneDescription scene = scene_with("pose = { root = 90, elbow = 90, grip = 0.25 }");
    expect_near(position_of(scene, "a.shoulder"), Vec3::Zero());
    expect_near(position_of(scene, "a.upper"), Vec3(1, 1, 0));
    // The elbow's second body is the upper arm: a turn of it by 90 degrees about y is one of the lower arm by -90.
    expect_near(position_of(scene, "a.lower"), Vec3(1, 2, 0.5));
    expect_near(position_of(scene, "a.hand"), Vec3(1, 2, 1.25));
    expect_near(position_of(scene, "a.bead") - position_of(scene, "a.hand"), Vec3(1, 0, 0));
    expect_near(find_body(scene, "a.upper").velocity, Vec3(0, 1, 0));
    expect_closed(scene);
    const JointDescription& root = scene.joints[0];
    const Quat turn = (scene.bodies[*root.first].rotation * root.frame_first).conjugate() *
                      (scene.bodies[*root.second].rotation * root.frame_second);
    EXPECT_NEAR(2.0 * atan2_stable(turn.x(), turn.w()), pi / 2, exact);
}

TEST(Templates, TheWorldAndFixedBodiesStayInAPose) {
    const std::string lines = R"(format = 1
[template.t]
[[template.t.body]]
name = "tip"
shape = { type = "sphere", radius = 0.1 }
position = [1, 0, 0]
[[template.t.joint]]
name = "pin"
type = "hinge"
bodies = ["tip", "world"]
anchor = [0, 0, 0]
axis = [0, 0, 1]
[[instance]]
template = "t"
name = "i"
position = [0, 5, 0]
pose = { pin = -90 }
)";
    const SceneDescription scene = parse_scene(lines, "scene.toml");
    expect_near(position_of(scene, "i.tip"), Vec3(0, 6, 0));
    expect_near(scene.joints[0].anchor_second, Vec3(0, 5, 0));
}

TEST(Templates, LoopsStayClosedInAPose) {
    // A parallelogram: two rockers of 1 m on a ground, with a bar between their tips.
    const std::string parallelogram = R"(format = 1
[template.t]
[[template.t.body]]
name = "ground"
type = "fixed"
shape = { type = "box", size = [2, 0.1, 0.1] }
[[template.t.body]]
name = "left"
shape = { type = "box", size = [0.1, 1, 0.1] }
position = [-1, 0.5, 0]
[[template.t.body]]
name = "right"
shape = { type = "box", size = [0.1, 1, 0.1] }
position = [1, 0.5, 0]
[[template.t.body]]
name = "bar"
shape = { type = "box", size = [2, 0.1, 0.1] }
position = [0, 1, 0]
[[template.t.joint]]
name = "a"
type = "hinge"
bodies = ["ground", "left"]
anchor = [-1, 0, 0]
axis = [0, 0, 1]
[[template.t.joint]]
name = "b"
type = "hinge"
bodies = ["ground", "right"]
anchor = [1, 0, 0]
axis = [0, 0, 1]
[[template.t.joint]]
name = "c"
type = "hinge"
bodies = ["left", "bar"]
anchor = [-1, 1, 0]
axis = [0, 0, 1]
[[template.t.joint]]
name = "d"
type = "hinge"
bodies = ["right", "bar"]
anchor = [1, 1, 0]
axis = [0, 0, 1]
[[instance]]
template = "t"
name = "i"
)";
    const SceneDescription scene = parse_scene(parallelogram + "pose = { a = 30, b = 30, c = -30 }", "scene.toml");
    expect_near(position_of(scene, "i.bar"), Vec3(-0.5, std::sqrt(0.75), 0));
    expect_closed(scene);
    // The bar stays level and the right rocker follows, because they have no other place.
    const SceneDescription found = parse_scene(parallelogram + "pose = { a = 30 }", "scene.toml");
    expect_near(position_of(found, "i.bar"), Vec3(-0.5, std::sqrt(0.75), 0), 1e-11);
    expect_closed(found, 1e-11);
    const std::vector<std::pair<std::string, std::string>> open = {
        {"pose = { a = 30, b = 25, c = -30 }", "opens the joint \"d\""},
        {"pose = { a = 30, b = 25, c = -30, d = -30 }", "opens the joint \"d\""},
        {"pose = { a = 30, d = 30 }", "opens the joint \"d\""},
    };
    for (const auto& [pose, phrase] : open) {
        try {
            parse_scene(parallelogram + pose, "scene.toml");
            ADD_FAILURE() << "an open loop: " << pose;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(phrase), std::string::npos) << error.what();
        }
    }
    const std::string limited =
        std::string(parallelogram).replace(parallelogram.find("name = \"b\""), 10, "name = \"b\"\nlimits = [-20, 20]");
    try {
        parse_scene(limited + "pose = { a = 30 }", "scene.toml");
        ADD_FAILURE() << "beyond a limit";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("moves the joint \"b\", so that its loop stays closed, to 30 degrees"),
                  std::string::npos)
            << error.what();
    }
}

// A slider-crank: the crank of 1 m at 30 degrees puts the slider to cos(30) + sqrt(9 - sin(30)^2).
TEST(Templates, ASliderFollowsItsCrank) {
    const std::string engine = R"(format = 1
[template.engine]
[[template.engine.body]]
name = "crank"
shape = { type = "box", size = [1, 0.1, 0.1] }
position = [0.5, 0, 0]
[[template.engine.body]]
name = "rod"
shape = { type = "box", size = [3, 0.1, 0.1] }
position = [2.5, 0, 0]
[[template.engine.body]]
name = "piston"
shape = { type = "box", size = [0.5, 0.5, 0.5] }
position = [4, 0, 0]
[[template.engine.joint]]
name = "main"
type = "hinge"
bodies = ["world", "crank"]
anchor = [0, 0, 0]
axis = [0, 0, 1]
[[template.engine.joint]]
name = "big end"
type = "hinge"
bodies = ["crank", "rod"]
anchor = [1, 0, 0]
axis = [0, 0, 1]
[[template.engine.joint]]
name = "wrist"
type = "hinge"
bodies = ["rod", "piston"]
anchor = [4, 0, 0]
axis = [0, 0, 1]
[[template.engine.joint]]
name = "cylinder"
type = "slider"
bodies = ["world", "piston"]
axis = [1, 0, 0]
[[instance]]
template = "engine"
name = "e"
pose = { main = 30 }
)";
    const SceneDescription scene = parse_scene(engine, "scene.toml");
    expect_near(position_of(scene, "e.piston"), Vec3(std::sqrt(0.75) + std::sqrt(9.0 - 0.25), 0, 0), 1e-11);
    expect_closed(scene, 1e-11);
}

TEST(Templates, GrowInSize) {
    const SceneDescription one = scene_with(""), two = scene_with("scale = 2");
    expect_near(position_of(two, "a.bead"), 2.0 * position_of(one, "a.bead"));
    EXPECT_EQ(std::get<BoxShape>(find_body(two, "a.upper").shape).size.x(), 4.0);
    EXPECT_EQ(find_body(two, "a.shoulder").density, 3.0);
    EXPECT_EQ(find_body(two, "a.shoulder").mass, std::nullopt) << "the density gives it";
    expect_closed(two);
    const JointAxis &turn = two.joints[0].turn[0], &move = two.joints[2].move[0];
    EXPECT_DOUBLE_EQ(turn.upper, 100.0 * pi / 180.0);
    EXPECT_DOUBLE_EQ(turn.spring->stiffness, 2.0 * 16);  // N m/rad: forces grow by 8, arms by 2
    EXPECT_DOUBLE_EQ(turn.spring->damping, 3.0 * 16 * std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(turn.motor->max_force, 6.0 * 16);
    EXPECT_DOUBLE_EQ(*turn.motor->speed, 4.0);
    EXPECT_DOUBLE_EQ(two.joints[0].break_torque, 7.0 * 16);
    EXPECT_DOUBLE_EQ(two.joints[0].break_force, 8.0 * 8);
    EXPECT_DOUBLE_EQ(move.upper, 1.0);
    EXPECT_DOUBLE_EQ(move.spring->stiffness, 2.0 * 4);
    EXPECT_DOUBLE_EQ(two.joints[3].length, 2.0);
}

TEST(Templates, HaveAGivenMass) {
    const SceneDescription scene = scene_with("mass = 70");
    double all = 0.0;
    for (const BodyDescription& body : scene.bodies) all += body.mass.value();
    EXPECT_NEAR(all, 70.0, 1e-12);
    const double ball = 3.0 * 4.0 / 3.0 * pi, box = 1000 * 2 * 0.04;
    EXPECT_NEAR(*find_body(scene, "a.shoulder").mass / *find_body(scene, "a.upper").mass, ball / box, 1e-13);
}

TEST(Templates, AreCopied) {
    const SceneDescription scene = scene_with(
        "position = [0, 1, 0]\ngrid = { count = [2, 1, 1], spacing = 20 }\ncolors = [\"#010101\", \"#020202\"]\n");
    ASSERT_EQ(scene.bodies.size(), 10u);
    expect_near(position_of(scene, "a.1.hand") - position_of(scene, "a.0.hand"), Vec3(20, 0, 0));
    EXPECT_EQ(scene.joints.at(5).name, "a.1.elbow");
    EXPECT_EQ(scene.joints.at(5).first, 7u);
    EXPECT_EQ(find_body(scene, "a.1.hand").appearance.color, find_body(scene, "a.1.bead").appearance.color);
    const SceneDescription scattered = scene_with("scatter = { count = 3, size = [40, 40, 40] }");
    ASSERT_EQ(scattered.bodies.size(), 15u);
    expect_closed(scattered);
    EXPECT_NEAR((position_of(scattered, "a.2.hand") - position_of(scattered, "a.2.shoulder")).norm(), 4.0, 1e-13);
}

TEST(Templates, HaveOneColor) {
    const auto colors = [](const std::string& keys) {
        std::vector<Color> list;
        for (const BodyDescription& body : scene_with(keys).bodies) list.push_back(body.appearance.color);
        return list;
    };
    EXPECT_EQ(colors("color = \"#010203\"\n"), std::vector<Color>(5, Color{1, 2, 3}));
    EXPECT_EQ(colors("color = \"#010203\"\ngrid = { count = [2, 1, 1], spacing = 20 }\n"),
              std::vector<Color>(10, Color{1, 2, 3}));
    EXPECT_EQ(colors("color = \"#010203\"\ncolors = [\"#040506\"]\ngrid = { count = [2, 1, 1], spacing = 20 }\n"),
              std::vector<Color>(10, Color{4, 5, 6}));
}

TEST(Templates, ComeFromAFile) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tumble_templates";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "ball.toml") << "format = 1\n[materials.red]\ncolor = \"#ff0000\"\n[[body]]\nname = \"b\"\n"
                                           "material = \"red\"\nshape = { type = \"sphere\", radius = 0.5 }\n";
    std::ofstream(folder / "bad.toml") << "format = 1\n[light]\nshadows = true\n";
    const auto scene_of = [&](const std::string& file, FileList* read) {
        return parse_scene(
            "format = 1\n[template.t]\nfile = \"" + file + "\"\n[[instance]]\ntemplate = \"t\"\nname = \"i\"\n",
            folder / "scene.toml", {}, read);
    };
    FileList read;
    const SceneDescription scene = scene_of("ball.toml", &read);
    EXPECT_EQ(scene.bodies.at(0).name, "i.b");
    EXPECT_EQ(scene.bodies.at(0).appearance.color, (Color{255, 0, 0}));
    EXPECT_NE(std::find(read.begin(), read.end(), folder / "ball.toml"), read.end());
    for (const auto& [file, phrase] : {std::pair("none.toml", "scene.toml:3:8: error: file \"none.toml\""),
                                       std::pair("bad.toml", "bad.toml:2:2: error: unknown key \"light\"")}) {
        try {
            scene_of(file, nullptr);
            ADD_FAILURE() << file;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(phrase), std::string::npos) << error.what();
        }
    }
}

TEST(Templates, RefuseMistakes) {
    const std::string instance = "[[instance]]\ntemplate = \"arm\"\nname = \"a\"\n";
    const struct {
        std::string lines, phrase;
    } mistakes[] = {
        {"[[instance]]\ntemplate = @\"arms\"\nname = \"a\"", "is not the name of a template (did you mean \"arm\"?)"},
        {"@[[instance]]\ntemplate = \"arm\"", "[[instance]] needs \"name\""},
        {"@[[instance]]\nname = \"a\"", "[[instance]] needs \"template\""},
        {instance + "[[instance]]\ntemplate = \"arm\"\nname = @\"a\"", "name must be unique, and another body has it"},
        {instance + "scale = @0", "scale must be from 0.001"},
        {instance + "mass = @0", "mass must be above 0"},
        {instance + "color = @\"red\"", "color must be a color"},
        {instance + "colors = @[\"#010101\"]", "needs a grid or a scatter"},
        {instance + "pose = { elbo = @3 }", "is not the name of a joint of the template (did you mean \"elbow\"?)"},
        {instance + "pose = { rope = @3 }", "is for hinges and sliders (given a joint of type \"distance\")"},
        {instance + "pose = { root = @101 }", "must be within the limits of the joint, -100 to 100 degrees"},
        {instance + "pose = { grip = @0.6 }", "must be within the limits of the joint, -0.5 to 0.5 m"},
        {instance + "grid = @{ count = [1000, 1000, 1], spacing = 9 }", "makes too many bodies"},
        {instance + "scatter = @{ count = 9, size = [1, 1, 1] }", "is too crowded"},
        {"@[template.empty]", "empty holds no body: give at least one"},
        {"[template.b]\n@[[template.b.instance]]\ntemplate = \"b\"\nname = \"i\"", "is not for templates"},
        {"[template.b]\n[[template.b.body]]\nshape = { type = \"sphere\", radius = @0 }", "radius must be"},
        {"[template.b]\n[[template.b.@boddy]]\nx = 1", "unknown key \"boddy\" in [template.b]"},
        {"[template.b]\nfile = \"b.toml\"\n@[[template.b.body]]\nx = 1", "and file exclude each other"},
    };
    for (const auto& mistake : mistakes) {
        const std::string text = arm + mistake.lines;
        const std::size_t mark = text.find('@');
        ASSERT_NE(mark, std::string::npos) << text;
        const std::string before = text.substr(0, mark);
        const auto line_number = 1 + std::count(before.begin(), before.end(), '\n');
        const std::string expected = "dir/scene.toml:" + std::to_string(line_number) + ":" +
                                     std::to_string(mark - before.rfind('\n')) + ": error: ";
        std::string error = "no error";
        try {
            parse_scene(before + text.substr(mark + 1), "dir/scene.toml");
        } catch (const InputError& e) {
            error = e.what();
        }
        EXPECT_EQ(error.substr(0, expected.size()), expected) << mistake.lines << "\n" << error;
        EXPECT_NE(error.find(mistake.phrase), std::string::npos) << mistake.lines << "\n" << error;
    }
}

}  // namespace
}  // namespace tumble::templates_test
