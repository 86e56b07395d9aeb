// [[joint]]: frames, coordinates at the start, and values of every type.
#include "core/deterministic_math.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tumble::joints_test {
namespace {

constexpr double exact = 1e-14;

/// Two turned boxes.
const std::string bodies = R"(format = 1
[[body]]
name = "a"
shape = { type = "box", size = [1, 1, 1] }
position = [0.3, -2, 0.7]
rotation = { axis = [1, 2, 3], angle = 40 }
[[body]]
name = "b"
shape = { type = "box", size = [1, 1, 1] }
position = [1.5, 0.2, 0.1]
rotation = { axis = [-3, 1, 1], angle = 100 }
)";

SceneDescription scene_with(const std::string& lines) { return parse_scene(bodies + lines, "scene.toml"); }

std::string joint(const std::string& type, const std::string& lines, const std::string& sides = "\"a\", \"b\"") {
    return "[[joint]]\ntype = \"" + type + "\"\nbodies = [" + sides + "]\n" + lines;
}

/// The frames of a joint in the world, from the poses of its bodies.
struct World {
    Vec3 first, second;  // anchors
    Quat frame_first, frame_second;

    Vec3 apart() const { return frame_first.conjugate() * (second - first); }  // coordinates of displacement
    Quat turn() const { return frame_first.conjugate() * frame_second; }
    double hinge_angle() const { return 2.0 * atan2_stable(turn().x(), turn().w()); }
};

World world_of(const SceneDescription& scene, const JointDescription& joint) {
    const auto place = [&](const std::optional<std::size_t>& body, const Vec3& p, const Quat& q) {
        if (!body) return std::pair(p, q);
        const BodyDescription& b = scene.bodies[*body];
        return std::pair<Vec3, Quat>(b.position + b.rotation * p, b.rotation * q);
    };
    const auto [p1, q1] = place(joint.first, joint.anchor_first, joint.frame_first);
    const auto [p2, q2] = place(joint.second, joint.anchor_second, joint.frame_second);
    return {p1, p2, q1, q2};
}

void expect_equal(const Vec3& a, const Vec3& b, double tolerance = exact) { EXPECT_LE((a - b).norm(), tolerance); }

using Motion = JointAxis::Motion;

std::string motions_of(const JointDescription& joint) {
    std::string text;
    for (const auto* axes : {&joint.move, &joint.turn})
        for (const JointAxis& axis : *axes)
            text += axis.motion == Motion::locked ? '-' : axis.motion == Motion::free ? 'f' : 'l';
    return text;
}

TEST(Joints, AllCoordinatesAreZeroAtTheStart) {
    const std::string anchor = "anchor = [1, 2, 3]\n", axis = "axis = [0.2, -1, 0.4]\n";
    const struct {
        std::string type, lines, motions;
    } cases[] = {
        {"fixed", anchor, "------"},
        {"hinge", anchor + axis, "---f--"},
        {"ball", anchor, "---fff"},
        {"ball", anchor + axis + "twist = [-20, 30]\nswing = 50\n", "---lff"},
        {"slider", anchor + axis, "f-----"},
        {"slider", axis, "f-----"},
        {"universal", anchor + "axis = [1, 1, 0]\nsecond_axis = [1, -1, 3]\n", "---ff-"},
        {"cylindrical", anchor + axis + "turn_limits = [-3, 3]\n", "f--l--"},
        {"planar", anchor + axis, "-fff--"},
        {"6dof", anchor + axis + "move_y = \"free\"\nturn_z = [-3, 4]\n", "-f---l"},
    };
    for (const auto& one : cases) {
        for (const std::string sides : {"\"a\", \"b\"", "\"world\", \"b\"", "\"a\", \"world\""}) {
            const SceneDescription scene = scene_with(joint(one.type, one.lines, sides));
            ASSERT_EQ(scene.joints.size(), 1u);
            const World world = world_of(scene, scene.joints[0]);
            expect_equal(world.apart(), Vec3::Zero());
            EXPECT_LE(world.turn().vec().norm(), exact) << one.type;
            EXPECT_EQ(motions_of(scene.joints[0]), one.motions) << one.type;
            if (one.lines.find(anchor) != std::string::npos) expect_equal(world.first, Vec3(1, 2, 3));
            if (one.lines.find(axis) != std::string::npos) {
                expect_equal(world.frame_first * Vec3::UnitX(), Vec3(0.2, -1, 0.4).normalized());
            }
        }
    }
}

TEST(Joints, TheAxesOfAUniversalJointAreItsFramesXAndY) {
    const SceneDescription scene =
        scene_with(joint("universal", "anchor = [0, 0, 0]\naxis = [1, 1, 0]\nsecond_axis = [0, 0, -2]\n"));
    const World world = world_of(scene, scene.joints[0]);
    expect_equal(world.frame_first * Vec3::UnitX(), Vec3(1, 1, 0).normalized());
    expect_equal(world.frame_second * Vec3::UnitY(), -Vec3::UnitZ());
}

TEST(Joints, AStartAngleTurnsTheFirstFrameBack) {
    for (const double angle : {-170.0, -30.0, 90.0}) {
        const SceneDescription scene =
            scene_with(joint("hinge", "anchor = [0, 0, 0]\naxis = [0, 1, 1]\nlimits = [-175, 120]\nstart_angle = " +
                                          std::to_string(angle)));
        EXPECT_NEAR(world_of(scene, scene.joints[0]).hinge_angle(), angle * pi / 180.0, exact);
    }
    const SceneDescription scene = scene_with(
        joint("cylindrical", "anchor = [1, 0, 0]\naxis = [0, 1, 1]\nstart_position = 0.25\nstart_angle = 9"));
    const World world = world_of(scene, scene.joints[0]);
    EXPECT_NEAR(world.hinge_angle(), 9.0 * pi / 180.0, exact);
    expect_equal(world.apart(), Vec3(0.25, 0, 0));
    expect_equal(world.second, Vec3(1, 0, 0));
}

TEST(Joints, AnchorsAndAxesInTheFramesOfTheBodies) {
    // The sphere's point (0, 0, 1) is where the box has (2, 0, 0); both axes are the world's y.
    const std::string two = R"(format = 1
[[body]]
name = "box"
shape = { type = "box", size = [1, 1, 1] }
rotation = { axis = [0, 1, 0], angle = 90 }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 1 }
position = [0, 0, -3]
)";
    const auto read = [&](const std::string& lines) { return parse_scene(two + lines, "scene.toml"); };
    const std::string sides = "\"box\", \"ball\"";
    const SceneDescription hinge = read(
        joint("hinge", "anchors = [[2, 0, 0], [0, 0, 1]]\naxes = [[0, 1, 0], [0, 3, 0]]\nstart_angle = 10", sides));
    expect_equal(hinge.joints[0].anchor_first, Vec3(2, 0, 0));
    expect_equal(hinge.joints[0].anchor_second, Vec3(0, 0, 1));
    EXPECT_NEAR(world_of(hinge, hinge.joints[0]).hinge_angle(), 10.0 * pi / 180.0, exact);
    const SceneDescription slider =
        read(joint("slider", "anchors = [[2, 0, 0], [0, 0, 0]]\naxis = [0, 0, 1]\nlimits = [-2, 0]", sides));
    expect_equal(world_of(slider, slider.joints[0]).apart(), Vec3(-1, 0, 0));
    const SceneDescription given_in_first =
        read(joint("hinge", "frame = \"first\"\nanchor = [2, 0, 0]\naxis = [1, 0, 0]", sides));
    const World world = world_of(given_in_first, given_in_first.joints[0]);
    expect_equal(world.first, Vec3(0, 0, -2));
    expect_equal(world.frame_second * Vec3::UnitX(), -Vec3::UnitZ());
    const SceneDescription ball =
        read(joint("ball", "anchor = [0, 0, 0]\naxes = [[1, 0, 0], [0, 0, 1]]\nsnap = true\nswing = 10", sides));
    EXPECT_NEAR(ball.joints[0].swing.value()[0], 10.0 * pi / 180.0, exact);
    expect_equal(world_of(ball, ball.joints[0]).frame_second * Vec3::UnitX(), Vec3::UnitZ());
}

TEST(Joints, SnapAcceptsAGap) {
    const SceneDescription scene = scene_with(joint("ball", "anchors = [[0, 0, 0], [0, 0, 0]]\nsnap = true"));
    EXPECT_GT(world_of(scene, scene.joints[0]).apart().norm(), 1.0);
}

TEST(Joints, DistancesAreRodsRopesOrSprings) {
    const std::string anchors = "anchors = [[0, 0, 0], [0, 0, 0]]\n";
    const double start = Vec3(1.2, 2.2, -0.6).norm();
    const auto read = [&](const std::string& lines) {
        return scene_with(joint("distance", anchors + lines)).joints.at(0);
    };
    const JointDescription rod = read("");
    EXPECT_EQ(rod.move[0].motion, Motion::locked);
    EXPECT_NEAR(rod.length, start, exact);
    EXPECT_TRUE(rod.collide);
    const JointDescription rope = read("max_length = 3\nlimit_restitution = 0.5\ncollide = false");
    EXPECT_EQ(rope.move[0].motion, Motion::limited);
    EXPECT_EQ(rope.move[0].lower, -infinity);
    EXPECT_EQ(rope.move[0].upper, 3.0);
    EXPECT_EQ(rope.move[0].restitution, 0.5);
    EXPECT_FALSE(rope.collide);
    const JointDescription strut = read("min_length = 1\nspring = { stiffness = 3, rest = 2 }");
    EXPECT_EQ(strut.move[0].lower, 1.0);
    EXPECT_EQ(strut.move[0].upper, infinity);
    EXPECT_EQ(strut.move[0].spring.value().rest, 2.0);
    const JointDescription spring = read("spring = { frequency = 3, damping_ratio = 0.1 }\nfriction = 2");
    EXPECT_EQ(spring.move[0].motion, Motion::free);
    EXPECT_EQ(spring.move[0].spring.value().frequency, 3.0);
    EXPECT_EQ(spring.move[0].spring.value().damping_ratio, 0.1);
    EXPECT_NEAR(spring.move[0].spring.value().rest, start, exact);
    EXPECT_EQ(spring.move[0].friction, 2.0);
    EXPECT_EQ(read("length = 3\nsnap = true").length, 3.0);
}

TEST(Joints, ValuesOfAHinge) {
    const SceneDescription scene = scene_with(joint("hinge", R"(name = "door"
anchor = [0, 0, 0]
axis = [0, 1, 0]
limits = [-90, 45]
limit_restitution = 0.25
spring = { stiffness = 50, damping = 2, rest = 30 }
motor = { target = -60, stiffness = 7, damping = 8, max_torque = 9 }
friction = 0.1
friction_coefficient = 0.3
bearing_radius = 0.02
break_force = 500
break_torque = 20
break_impulse = 3
collide = true
enabled = [0.5, 3.5]
)") + joint("ball", "anchor = [0, 0, 0]\nspring = { stiffness = 2 }\nfriction = 3\nenabled = [1]"));
    const JointDescription& door = scene.joints.at(0);
    const JointAxis& turn = door.turn[0];
    EXPECT_EQ(door.name, "door");
    EXPECT_EQ(door.first, 0u);
    EXPECT_EQ(door.second, 1u);
    EXPECT_DOUBLE_EQ(turn.lower, -pi / 2);
    EXPECT_DOUBLE_EQ(turn.upper, pi / 4);
    EXPECT_EQ(turn.restitution, 0.25);
    EXPECT_EQ(turn.spring.value().stiffness, 50.0);
    EXPECT_EQ(turn.spring.value().damping, 2.0);
    EXPECT_DOUBLE_EQ(turn.spring.value().rest, pi / 6);
    ASSERT_EQ(turn.motor.value().targets.size(), 1u);
    EXPECT_DOUBLE_EQ(turn.motor.value().targets[0].value, -pi / 3);
    EXPECT_EQ(turn.motor.value().stiffness, 7.0);
    EXPECT_EQ(turn.motor.value().damping, 8.0);
    EXPECT_EQ(turn.motor.value().max_force, 9.0);
    EXPECT_EQ(turn.friction, 0.1);
    EXPECT_EQ(door.friction_coefficient, 0.3);
    EXPECT_EQ(door.bearing_radius, 0.02);
    EXPECT_EQ(door.break_force, 500.0);
    EXPECT_EQ(door.break_torque, 20.0);
    EXPECT_EQ(door.break_impulse, 3.0);
    EXPECT_TRUE(door.collide);
    EXPECT_EQ(door.start, 0.5);
    EXPECT_EQ(door.end, 3.5);
    const JointDescription& ball = scene.joints.at(1);
    EXPECT_EQ(ball.name, "joint 1");
    EXPECT_FALSE(ball.collide);
    EXPECT_EQ(ball.start, 1.0);
    EXPECT_EQ(ball.end, infinity);
    for (const JointAxis& axis : ball.turn) {
        EXPECT_EQ(axis.spring.value().stiffness, 2.0);
        EXPECT_EQ(axis.friction, 3.0);
    }
}

TEST(Joints, CoordinatesOfASixJoint) {
    const JointDescription six = scene_with(joint("6dof", R"(anchor = [0, 0, 0]
axis = [0, 0, 1]
second_axis = [1, 0, 0]
move_x = { limits = [-1, 2], limit_restitution = 0.5, motor = { speed = 3, max_force = 4 } }
move_y = { spring = { stiffness = 5 } }
turn_x = { friction = 6 }
turn_y = [-10, 20]
turn_z = { motor = { keyframes = [{ time = 0, value = 0 }, { time = 2, value = 90 }], stiffness = 1 } }
)"))
                                     .joints.at(0);
    EXPECT_EQ(motions_of(six), "lf-flf");
    EXPECT_EQ(six.move[0].restitution, 0.5);
    EXPECT_EQ(six.move[0].motor.value().speed, 3.0);
    EXPECT_EQ(six.move[0].motor.value().max_force, 4.0);
    EXPECT_EQ(six.move[1].spring.value().stiffness, 5.0);
    EXPECT_EQ(six.turn[0].friction, 6.0);
    EXPECT_DOUBLE_EQ(six.turn[1].upper, pi / 9);
    ASSERT_EQ(six.turn[2].motor.value().targets.size(), 2u);
    EXPECT_EQ(six.turn[2].motor.value().targets[1].time, 2.0);
    EXPECT_DOUBLE_EQ(six.turn[2].motor.value().targets[1].value, pi / 2);
}

TEST(Joints, ACordLiesBetweenTheAnchors) {
    const SceneDescription scene =
        scene_with(joint("distance", "name = \"rod\"\nvisible = true\nanchors = [[1, 2, 3], [4, 5, 6]]\n") +
                   joint("ball", "name = \"hook\"\nanchor = [7, 8, 9]\n", "\"a\", \"world\"") +
                   "[[cord]]\njoint = \"rod\"\nradius = 0.25\n[[cord]]\njoint = \"hook\"\n");
    ASSERT_EQ(scene.cords.size(), 3u) << "and one of the visible joint";
    EXPECT_EQ(scene.cords[2].joint, 0u);
    const CordDescription &rod = scene.cords[0], &hook = scene.cords[1];
    EXPECT_EQ(rod.joint, 0u);
    EXPECT_EQ(rod.body, 1u);
    expect_equal(rod.point, Vec3(4, 5, 6));
    EXPECT_EQ(rod.anchor_body, 0u);
    expect_equal(rod.anchor, Vec3(1, 2, 3));
    EXPECT_EQ(rod.radius, 0.25);
    EXPECT_EQ(hook.joint, 1u);
    EXPECT_EQ(hook.body, 0u);
    EXPECT_EQ(hook.anchor_body, std::nullopt);
    expect_equal(hook.anchor, Vec3(7, 8, 9));
}

}  // namespace
}  // namespace tumble::joints_test
