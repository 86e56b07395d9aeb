// Hanging chains and bridges against their closed forms; heavy loads on light links; redundant joints.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace tumble::statics_test {
using namespace tumble::testing;

namespace {

/// Links of a chain between (0, 0, 0) and (span, 0, 0), with ball joints, at the angles of equilibrium:
/// tan(theta_i) = V_i / H with V the vertical force in the middle of link i.
struct Chain {
    SceneDescription scene;
    double lowest = 0.0, force = 0.0;
};

Chain hanging_chain(int links, double length, double span, const std::function<double(int)>& mass) {
    // Weight to the right of link i's middle, minus the right end's vertical reaction; symmetric loads only.
    std::vector<double> v(static_cast<std::size_t>(links));
    double total = 0.0;
    for (int i = 0; i < links; ++i) total += 9.81 * mass(i);
    double sum = -0.5 * total;
    for (int i = 0; i < links; ++i) {
        sum += 0.5 * 9.81 * mass(i);
        v[std::size_t(i)] = sum;
        sum += 0.5 * 9.81 * mass(i);
    }
    double low = 1e-6, high = 1e9;  // H by bisection of the span
    for (int k = 0; k < 400; ++k) {
        const double h = std::sqrt(low * high);
        double wide = 0.0;
        for (const double one : v) wide += length * h / std::hypot(h, one);
        (wide < span ? low : high) = h;
    }
    Chain chain;
    chain.scene.simulation.steps_per_frame = 16;
    Vec3 at = Vec3::Zero();
    for (int i = 0; i < links; ++i) {
        const double angle = std::atan2(v[std::size_t(i)], low);
        const Quat q = turn(Vec3::UnitZ(), angle);
        const Vec3 along = q * Vec3(length, 0.0, 0.0);
        BodyDescription& box = add_box(chain.scene, {length, 0.2 * length, 0.2 * length}, at + 0.5 * along, mass(i));
        box.rotation = q;
        const std::size_t body = chain.scene.bodies.size() - 1;
        add_joint(chain.scene, JointType::ball, i == 0 ? std::nullopt : std::optional(body - 1), body, at);
        at += along;
        chain.lowest = std::min(chain.lowest, at.y());
    }
    add_joint(chain.scene, JointType::ball, chain.scene.bodies.size() - 1, std::nullopt, at);
    chain.force = std::hypot(low, 0.5 * total);
    return chain;
}

struct Rest {
    double sag = 0.0, force = 0.0, gap = 0.0;
    bool asleep = true;
};

Rest run_chain(const Chain& chain, double seconds, bool sleep = true) {
    SceneDescription scene = chain.scene;
    scene.simulation.sleep = sleep;
    World world(scene);
    Rest rest;
    for (int frame = 0; frame < int(60 * seconds); ++frame) {
        world.advance_frame();
        rest.gap = std::max(rest.gap, largest_gap(world));
    }
    double lowest = 0.0;
    for (const JointState& joint : world.joint_states()) lowest = std::min(lowest, joint.point.y());
    rest.sag = std::abs(lowest - chain.lowest);
    rest.force = std::abs(world.joint_states()[0].force.norm() - chain.force);
    for (const BodyState& body : world.snapshot().bodies) rest.asleep = rest.asleep && body.asleep;
    return rest;
}

TEST(JointStatics, AHangingChainStaysInItsClosedForm) {
    const Chain chain = hanging_chain(20, 0.1, 1.0, [](int) { return 1.0; });
    EXPECT_NEAR(chain.lowest, -0.79827310891563972, 1e-12);
    EXPECT_NEAR(chain.force, 100.651790329227215, 1e-9);
    const Rest rest = run_chain(chain, 2.0);
    EXPECT_LT(rest.sag, 1e-9);
    EXPECT_LT(rest.force, 1e-6);
    EXPECT_LT(rest.gap, 1e-12);
    EXPECT_TRUE(rest.asleep);
}

TEST(JointStatics, ABridgeWithALoadAThousandTimesItsLinks) {
    const Chain chain = hanging_chain(21, 0.5, 10.0, [](int i) { return i == 10 ? 1000.0 : 1.0; });
    EXPECT_NEAR(chain.lowest, -1.56122670906513271, 1e-12);
    EXPECT_NEAR(chain.force, 15881.2055290885987, 1e-6);
    const Rest rest = run_chain(chain, 2.0, false);
    EXPECT_LT(rest.sag, 1e-8);
    EXPECT_LT(rest.gap, 1e-9);
}

// A ball of a ton below twenty links of a kilogram, let go 30 degrees aside: at one step a frame the links' swing under
// tension needs substeps.
TEST(JointStatics, AWreckingBall) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = 1;
    scene.simulation.sleep = false;
    const Quat aside = turn(Vec3::UnitZ(), std::numbers::pi / 6.0);
    for (std::size_t i = 0; i < 20; ++i) {
        BodyDescription& link = add_box(scene, {0.02, 0.1, 0.02}, aside * Vec3(0.0, -0.1 * (double(i) + 0.5), 0.0));
        link.rotation = aside;
        add_joint(scene, JointType::ball, i > 0 ? std::optional(i - 1) : std::nullopt, i,
                  aside * Vec3(0.0, -0.1 * double(i), 0.0));
    }
    add_sphere(scene, 0.2, aside * Vec3(0.0, -2.2, 0.0), 1000.0).rotation = aside;
    add_joint(scene, JointType::ball, 19, 20, aside * Vec3(0.0, -2.0, 0.0));
    World world(scene);
    const auto energy = [&] {
        const Measurement m = world.measure();
        return m.kinetic + m.potential;
    };
    const double start = energy();
    double gap = 0.0, change = 0.0;
    for (int frame = 0; frame < 120; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
        change = std::max(change, std::abs(energy() - start));
    }
    EXPECT_LT(gap, 1e-9);
    EXPECT_LT(change, 1e-5 * std::abs(start));
}

}  // namespace
}  // namespace tumble::statics_test
