// Every refusal of [[joint]], with its position. In the texts below an @ marks that position (it is removed before
// parsing), and the phrase follows the location in the message.
#include "core/error.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tumble::joint_errors_test {
namespace {

struct Mistake {
    std::string lines;
    std::string phrase;
};

/// Two dynamic boxes with edges of 1 m, 1 m apart along x; a wall, a carrier, and a grid.
const std::string bodies = R"(format = 1
[[body]]
name = "a"
shape = { type = "box", size = [1, 1, 1] }
[[body]]
name = "b"
shape = { type = "box", size = [1, 1, 1] }
position = [1, 0, 0]
[[body]]
name = "wall"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "carrier"
type = "kinematic"
shape = { type = "box", size = [1, 1, 1] }
[[body]]
name = "many"
shape = { type = "box", size = [1, 1, 1] }
position = [5, 0, 0]
grid = { count = [2, 1, 1], spacing = 2 }
)";

std::string error_of(const std::string& text) {
    try {
        parse_scene(text, "dir/scene.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void expect_joint_errors(const std::string& head, const std::vector<Mistake>& mistakes) {
    for (const Mistake& mistake : mistakes) {
        const std::string text = bodies + head + mistake.lines;
        const std::size_t mark = text.find('@');
        ASSERT_NE(mark, std::string::npos) << text;
        const std::string before = text.substr(0, mark), after = text.substr(mark + 1);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t column = mark - before.rfind('\n');
        const std::string expected =
            "dir/scene.toml:" + std::to_string(line) + ":" + std::to_string(column) + ": error: ";
        const std::string error = error_of(before + after);
        EXPECT_EQ(error.substr(0, expected.size()), expected) << mistake.lines << "\n" << error;
        EXPECT_NE(error.find(mistake.phrase), std::string::npos) << mistake.lines << "\n" << error;
    }
}

std::string of_type(const std::string& type) { return "[[joint]]\nbodies = [\"a\", \"b\"]\ntype = \"" + type + "\"\n"; }

const std::string hinge = of_type("hinge") + "anchor = [0.5, 0, 0]\naxis = [0, 0, 1]\n";
const std::string slider = of_type("slider") + "axis = [1, 0, 0]\n";
const std::string ball = of_type("ball") + "anchor = [0.5, 0, 0]\naxis = [1, 0, 0]\n";
const std::string rod = of_type("distance") + "anchors = [[0, 0, 0], [0, 0, 0]]\n";
const std::string six = of_type("6dof") + "anchor = [0.5, 0, 0]\n";

TEST(JointErrors, OfTypesAndBodies) {
    expect_joint_errors(
        "",
        {
            {"@[joint]\n", "must be an array of tables; write [[joint]] for each"},
            {"@[[joint]]\nbodies = [\"a\", \"b\"]", "[[joint]] needs \"type\""},
            {"@[[joint]]\ntype = \"fixed\"", "[[joint]] needs \"bodies\""},
            {"[[joint]]\ntype = @\"hing\"", "must be one of \"fixed\", \"hinge\", \"ball\""},
            {"[[joint]]\ntype = \"fixed\"\n@limit = 3",
             "unknown key \"limit\" in [[joint]] (did you mean \"limits\"?)"},
            {"[[joint]]\ntype = \"fixed\"\nbodies = @[\"a\"]", "must be an array of 2 names of bodies"},
            {"[[joint]]\ntype = \"fixed\"\nbodies = [\"a\", @\"c\"]", "\"c\" is not the name of a body (did you mean"},
            {"[[joint]]\ntype = \"fixed\"\nbodies = [\"a\", @\"many\"]", "name one of its copies, \"many.0\""},
            {"[[joint]]\ntype = \"fixed\"\nbodies = @[\"a\", \"a\"]",
             "must be two different ones (given [\"a\", \"a\"])"},
            {"[[joint]]\ntype = \"fixed\"\nbodies = @[\"world\", \"world\"]", "must be two different ones"},
            {"[[joint]]\ntype = \"fixed\"\nbodies = @[\"wall\", \"world\"]", "must name at least one dynamic body"},
            {"[[joint]]\ntype = \"fixed\"\nbodies = @[\"carrier\", \"wall\"]", "must name at least one dynamic body"},
            {"[[body]]\nname = \"world\"\nshape = { type = \"sphere\", radius = 1 }\n[[joint]]\ntype = \"fixed\"\n"
             "bodies = [\"a\", @\"world\"]",
             "a body has this name"},
            {of_type("fixed") + "name = @\"\"", "name must not be empty"},
            {of_type("fixed") + "name = \"j\"\n" + of_type("fixed") + "name = @\"j\"",
             "another joint has it (given \"j\")"},
            {of_type("fixed") + "swing = @30",
             "is a key of joints of another type: \"ball\" (given in a joint of type \"fixed\")"},
            {of_type("ball") + "move_x = @\"free\"", "another type: \"6dof\""},
            {rod + "break_torque = @3", "is a key of joints of another type"},
        });
}

TEST(JointErrors, OfPlaces) {
    expect_joint_errors(
        "",
        {
            {"@" + of_type("hinge") + "axis = [0, 0, 1]", "[[joint]] needs \"anchor\""},
            {"@" + of_type("hinge") + "anchor = [0.5, 0, 0]", "[[joint]] needs \"axis\""},
            {"@" + of_type("distance"), "[[joint]] needs \"anchors\""},
            {of_type("ball") + "anchor = [0, 0, 0]\nanchors = @[[0, 0, 0], [0, 0, 0]]", "exclude each other"},
            {of_type("hinge") + "anchor = [0, 0, 0]\naxis = [1, 0, 0]\naxes = @[[1, 0, 0], [1, 0, 0]]", "exclude"},
            {of_type("hinge") + "anchor = [0, 0, 0]\naxis = @[0, 0, 0]", "axis must not be zero"},
            {of_type("ball") + "anchors = @[[0.5, 0, 0], [-0.513, 0, 0]]",
             "anchors must meet at the start: give one anchor, or snap = true (given points 0.013 m apart)"},
            {of_type("slider") + "axis = [1, 0, 0]\nanchors = @[[0.5, 0.1, 0], [0.3, 0, 0]]", "points 0.1 m apart"},
            {of_type("hinge") + "anchor = [0, 0, 0]\naxes = @[[1, 0, 0], [1, 1e-5, 0]]", "axes must be parallel"},
            {of_type("universal") + "anchor = [0, 0, 0]\naxis = [1, 0, 0]\nsecond_axis = @[1, 1, 0]",
             "square to each other: give axes with an angle of 90 degrees (given one of 45 degrees)"},
            {of_type("universal") + "anchor = [0, 0, 0]\naxes = @[[1, 0, 0], [1, 0, 0]]", "given one of 0 degrees"},
            {"@" + of_type("universal") + "anchor = [0, 0, 0]\naxis = [1, 0, 0]", "needs \"second_axis\""},
            {of_type("fixed") + "frame = @\"first\"", "is the frame of anchor and axis"},
            {hinge + "frame = @\"body\"", "must be one of \"world\", \"first\", \"second\""},
            {slider + "anchors = [[0.5, 0, 0], [-0.5, 0, 0]]\nstart_position = @1", "and anchors exclude each other"},
            {hinge + "start_angle = @181", "start_angle must be from -180 to 180 degrees"},
            {of_type("6dof") + "anchors = @[[0.5, 0, 0], [-0.4, 0, 0]]\nmove_y = \"free\"", "where move_x is locked"},
            {of_type("6dof") + "anchors = [[0.5, 0, 0], [-0.4, 0, 0]]\nmove_x = @\"locked\"",
             "is locked, and at the start"},
            {of_type("6dof") + "anchor = [0.5, 0, 0]\naxes = @[[1, 0, 0], [0, 1, 0]]\nturn_y = \"free\"",
             "where turn_z is locked"},
        });
}

TEST(JointErrors, OfLimits) {
    expect_joint_errors(
        "",
        {
            {hinge + "limits = @[30, -30]", "must have the lower limit first"},
            {hinge + "limits = @[30, 30]", "must have the lower limit first"},
            {hinge + "limits = [0, @36001]", "must be from -36000 to 36000 degrees"},
            {hinge + "limits = @[10, 90]",
             "must contain the start, 0 degrees; give start_angle, or other limits, or snap = true (given [10, 90])"},
            {hinge + "start_angle = 95\nlimits = @[10, 90]", "must contain the start, 95 degrees"},
            {slider + "limits = @[0.1, 0.2]", "must contain the start, 0 m; give start_position"},
            {slider + "limits = [-1, @\"b\"]", "must be a number"},
            {hinge + "limit_restitution = @0.5", "needs limits (not given)"},
            {hinge + "limits = [-1, 1]\nlimit_restitution = @1.5", "must be from 0 to 1"},
            {ball + "swing = @180", "must be above 0 and below 180 degrees"},
            {ball + "swing = @0", "must be above 0 and below 180 degrees"},
            {ball + "swing = [20, @-1]", "must be above 0 and below 180 degrees"},
            {ball + "twist = @[10, 20]", "must contain the start, 0 degrees"},
            {ball + "twist = [@-190, 190]", "must be from -180 to 180"},
            {of_type("ball") + "anchor = [0.5, 0, 0]\nswing = @20", "needs an axis"},
            {of_type("ball") + "anchor = [0.5, 0, 0]\naxes = [[1, 0, 0], [0, 1, 0]]\nswing = @20",
             "must contain the start, 90 degrees"},
            {rod + "length = @2",
             "must be the distance at the start, 1 m: leave it out, or give snap = true (given 2)"},
            {rod + "length = @1\nmax_length = 2", "and max_length exclude each other"},
            {rod + "min_length = 2\nmax_length = @1", "must be above min_length"},
            {rod + "max_length = @0.5", "must contain the start, 1 m"},
            {six + "move_x = @[1, 2]", "must contain the start"},
            {six + "turn_x = @\"open\"", "must be one of \"free\", \"locked\""},
            {six + "turn_x = @true", "must be \"free\", \"locked\", [lower, upper] or a table"},
            {six + "turn_x = { limit_restitution = @1 }", "needs limits"},
            {six + "turn_x = { @limit = [0, 1] }", "unknown key \"limit\" in a coordinate"},
        });
}

TEST(JointErrors, OfSpringsAndMotors) {
    expect_joint_errors(
        "", {
                {hinge + "spring = { stiffness = @-1 }", "stiffness must be from 0"},
                {hinge + "spring = { stiffness = 1, damping = @-1 }", "damping must be from 0"},
                {hinge + "spring = { stiffness = 1, frequency = @2 }", "and stiffness exclude each other"},
                {hinge + "spring = { damping_ratio = @2 }", "needs a frequency"},
                {hinge + "spring = @{}", "needs a stiffness, a damping or a frequency"},
                {hinge + "spring = { @stiffnes = 1 }", "(did you mean \"stiffness\"?)"},
                {ball + "spring = { stiffness = 1, rest = @3 }", "is for joints with one coordinate"},
                {rod + "length = 1\nspring = @{ stiffness = 1 }", "needs a length that changes"},
                {rod + "friction = @1", "needs a length that changes"},
                {hinge + "motor = { speed = 1, target = @2 }", "and speed exclude each other"},
                {hinge + "motor = @{ max_torque = 2 }", "needs a speed, a target or keyframes"},
                {hinge + "motor = { speed = 1, max_force = @2 }", "give max_torque"},
                {slider + "motor = { speed = 1, max_torque = @2 }", "give max_force"},
                {hinge + "motor = { speed = 1, max_torque = @0 }", "must be above 0"},
                {hinge + "motor = { speed = 1, stiffness = @2 }", "is for a motor with a target"},
                {hinge + "motor = @{ target = 1 }", "a motor needs \"stiffness\""},
                {hinge + "motor = { keyframes = @[], stiffness = 1 }", "must hold at least one keyframe"},
                {hinge + "motor = { target = 1, stiffness = 1, interpolation = @\"linear\" }",
                 "is for a motor with keyframes"},
                {hinge + "motor = { keyframes = [{ time = 0, value = 0 }], stiffness = 1, interpolation = @\"even\" }",
                 "must be one of \"smooth\", \"linear\""},
                {hinge + "motor = { keyframes = [{ time = 1, value = 0 }, { time = @1, value = 2 }], stiffness = 1 }",
                 "must come after the keyframe before, at 1 s"},
                {hinge + "friction = @-1", "friction must be from 0"},
                {hinge + "friction_coefficient = @0.1", "needs a bearing_radius"},
                {hinge + "bearing_radius = @0.1", "needs a friction_coefficient"},
                {hinge + "armature = @0", "must be above 0"},
                {slider + "bearing_radius = @0.1", "is a key of joints of another type"},
            });
}

TEST(JointErrors, OfBreakingAndTime) {
    expect_joint_errors("", {
                                {hinge + "break_force = @0", "break_force must be above 0"},
                                {hinge + "break_torque = @-1", "break_torque must be above 0"},
                                {hinge + "break_impulse = @nan", "must be a finite number"},
                                {of_type("distance") + "anchors = [[0.5, 0, 0], [-0.5, 0, 0]]\nbreak_force = @3",
                                 "with a length above 0"},
                                {hinge + "enabled = @[3, 2]", "must end after it starts"},
                                {hinge + "enabled = @[]", "must be an array of one or two numbers"},
                                {hinge + "enabled = [@-1, 2]", "must be from 0"},
                                {hinge + "collide = @1", "must be true or false"},
                            });
}

TEST(JointErrors, OfGears) {
    const std::string joints = hinge + "name = \"wheel\"\n" + slider + "name = \"rack\"\n" + ball + "name = \"eye\"\n";
    const std::string gear = joints + "[[joint]]\ntype = \"gear\"\nname = \"gear\"\n";
    const std::string pair = gear + "joints = [\"wheel\", \"rack\"]\n";
    expect_joint_errors(
        "", {
                {joints + "@[[joint]]\ntype = \"gear\"\nratio = 2", "[[joint]] needs \"joints\""},
                {joints + "@[[joint]]\ntype = \"gear\"\njoints = [\"wheel\", \"rack\"]", "[[joint]] needs \"ratio\""},
                {gear + "joints = @[\"wheel\"]\nratio = 2", "must be an array of 2 names of joints, hinges or sliders"},
                {gear + "joints = [\"wheel\", @\"rac\"]\nratio = 2",
                 "\"rac\" is not the name of a joint (did you mean \"rack\"?)"},
                {gear + "joints = @[\"wheel\", \"wheel\"]\nratio = 2", "must name two different ones"},
                {gear + "joints = [@\"eye\", \"rack\"]\nratio = 2",
                 "must name a hinge or a slider: a gear couples no joint of type \"ball\""},
                {gear + "joints = [\"wheel\", @\"gear\"]\nratio = 2", "a gear couples no joint of type \"gear\""},
                {pair + "ratio = @0", "ratio must not be zero"},
                {pair + "ratio = @1e10", "ratio must be from -1000000000 to 1000000000"},
                {pair + "ratio = 2\nbodies = @[\"a\", \"b\"]", "is a key of joints of another type"},
                {pair + "ratio = 2\nmotor = @{ speed = 1 }", "is a key of joints of another type"},
                {pair + "ratio = 2\nbreak_force = @3", "the first joint, which is a hinge: give break_torque"},
                {hinge + "ratio = @2", "another type: \"gear\" (given in a joint of type \"hinge\")"},
                {pair + "ratio = 2\n[[cord]]\njoint = @\"gear\"", "is a gear, which has no anchors"},
            });
}

TEST(JointErrors, OfCords) {
    const std::string named = hinge + "name = \"pin\"\n[[cord]]\n";
    expect_joint_errors("", {
                                {named + "joint = @\"pim\"", "is not the name of a joint (did you mean \"pin\"?)"},
                                {"[[cord]]\njoint = @\"pin\"", "is not the name of a joint: there is none"},
                                {named + "joint = \"pin\"\nbody = @\"a\"", "and joint exclude each other"},
                                {named + "joint = \"pin\"\nanchor = @[0, 0, 0]", "and joint exclude each other"},
                            });
}

}  // namespace
}  // namespace tumble::joint_errors_test
