// The same motion seen in a mirror, from another side, and with bodies and joints listed backwards.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::symmetry_test {
using namespace tumble::testing;

namespace {

// The mirror x -> -x. A rotation about an axis becomes one about the mirrored axis, the other way round.
Vec3 mirrored(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }
Vec3 mirrored_spin(const Vec3& w) { return {w.x(), -w.y(), -w.z()}; }
Quat mirrored(const Quat& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

SceneDescription mirrored(SceneDescription scene) {
    for (BodyDescription& body : scene.bodies) {
        body.position = mirrored(body.position);
        body.rotation = mirrored(body.rotation);
        body.velocity = mirrored(body.velocity);
        body.angular_velocity = mirrored_spin(body.angular_velocity);
    }
    for (JointDescription& joint : scene.joints) {
        joint.anchor_first = mirrored(joint.anchor_first);
        joint.anchor_second = mirrored(joint.anchor_second);
        joint.frame_first = mirrored(joint.frame_first);
        joint.frame_second = mirrored(joint.frame_second);
    }
    return scene;
}

SceneDescription turned(SceneDescription scene, const Quat& by) {
    for (BodyDescription& body : scene.bodies) {
        body.position = by * body.position;
        body.rotation = by * body.rotation;
        body.velocity = by * body.velocity;
        body.angular_velocity = by * body.angular_velocity;
    }
    for (JointDescription& joint : scene.joints) {
        if (!joint.first) {
            joint.anchor_first = by * joint.anchor_first;
            joint.frame_first = by * joint.frame_first;
        }
        if (!joint.second) {
            joint.anchor_second = by * joint.anchor_second;
            joint.frame_second = by * joint.frame_second;
        }
    }
    return scene;
}

SceneDescription backwards(SceneDescription scene) {
    const std::size_t last = scene.bodies.size() - 1;
    std::reverse(scene.bodies.begin(), scene.bodies.end());
    std::reverse(scene.joints.begin(), scene.joints.end());
    for (JointDescription& joint : scene.joints)
        for (std::optional<std::size_t>* body : {&joint.first, &joint.second})
            if (*body) *body = last - **body;
    return scene;
}

/// A figure of a trunk, a head and four limbs of two parts, with limits, that falls aslant on the floor.
SceneDescription figure_scene() {
    SceneDescription scene;
    scene.simulation.sleep = false;
    add_body(scene, PlaneShape{Vec3::UnitY(), 0.0}, Vec3::Zero()).type = BodyType::fixed;
    const std::size_t trunk = scene.bodies.size();
    add_box(scene, {0.4, 0.6, 0.2}, {0.0, 1.6, 0.0}, 30.0);
    add_box(scene, {0.2, 0.25, 0.2}, {0.0, 2.05, 0.0}, 5.0);
    add_joint(scene, JointType::ball, trunk, trunk + 1, {0.0, 1.92, 0.0}, Vec3::UnitY()).swing = {0.6, 0.4};
    for (const double side : {-1.0, 1.0})
        for (const double height : {1.85, 1.27}) {
            const bool arm = height > 1.5;
            const std::size_t upper = scene.bodies.size();
            const double x = side * (arm ? 0.28 : 0.11), length = arm ? 0.35 : 0.45;
            add_box(scene, {0.1, length, 0.1}, {x, height - 0.5 * length, 0.0}, 3.0);
            add_box(scene, {0.09, length, 0.09}, {x, height - 1.55 * length, 0.0}, 2.0);
            add_joint(scene, JointType::ball, trunk, upper, {x, height, 0.0}, -Vec3::UnitY()).swing = {1.2, 0.9};
            JointDescription& hinge =
                add_joint(scene, JointType::hinge, upper, upper + 1, {x, height - 1.02 * length, 0.0}, Vec3::UnitX());
            hinge.turn[0].motion = JointAxis::Motion::limited;
            hinge.turn[0].lower = -0.05;
            hinge.turn[0].upper = 2.2;
        }
    for (std::size_t i = trunk; i < scene.bodies.size(); ++i) {
        scene.bodies[i].velocity = {0.7, -1.0, 0.4};
        scene.bodies[i].friction = 0.5;
    }
    return scene;
}

/// Largest distance of a body from its image, m.
template <class Image, class Index>
double distance(const World& world, const World& other, std::size_t bodies, const Image& image, const Index& index) {
    const Snapshot a = world.snapshot(), b = other.snapshot();
    double worst = 0.0;
    for (std::size_t i = 0; i < bodies; ++i)
        worst = std::max(worst, (image(a.bodies[i].origin) - b.bodies[index(i)].origin).norm());
    return worst;
}

void run_all(World& a, World& b, const SceneDescription& scene, double seconds) {
    run(a, scene, seconds);
    run(b, scene, seconds);
}

TEST(JointSymmetry, AFigureFallsAsItsMirrorImage) {
    const SceneDescription scene = figure_scene();
    World world(scene), other(mirrored(scene));
    run_all(world, other, scene, 1.0);
    const auto image = [](const Vec3& v) { return mirrored(v); };
    const auto index = [](std::size_t body) { return body; };
    EXPECT_LT(distance(world, other, scene.bodies.size(), image, index), 3e-8);  // rounding grows in contact
    // In contact a joint counts as closed from 1e-8 of the smaller body on, once the impulses have settled.
    EXPECT_LT(largest_gap(world), 1e-9);
    EXPECT_GT(world.snapshot().bodies[1].origin.y(), 0.0);  // the floor has stopped its fall
}

TEST(JointSymmetry, ADoublePendulumSwingsInAnyDirection) {
    SceneDescription scene = double_pendulum_scene(16);
    const Quat by = turn(Vec3::UnitY(), 37.0 * std::numbers::pi / 180.0);
    World world(scene), other(turned(scene, by));
    run_all(world, other, scene, 2.0);
    const auto image = [&](const Vec3& v) { return Vec3(by * v); };
    EXPECT_LT(distance(world, other, 2, image, [](std::size_t body) { return body; }), 1e-12);
}

TEST(JointSymmetry, TheOrderOfBodiesDoesNotMatter) {
    const SceneDescription scene = figure_scene(), reversed = backwards(scene);
    World world(scene), other(reversed);
    const std::size_t last = scene.bodies.size() - 1;
    run_all(world, other, scene, 0.75);
    const auto image = [](const Vec3& v) { return v; };
    EXPECT_LT(distance(world, other, scene.bodies.size(), image, [&](std::size_t body) { return last - body; }), 1e-8);
}

}  // namespace
}  // namespace tumble::symmetry_test
