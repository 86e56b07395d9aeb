// Pool balls racked in a triangle on a table, broken along the axis of symmetry: the motion stays symmetric. Each
// impact and each step solves many contacts at once, and no order of contacts or bodies may show in the answer.
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::rack_test {
using namespace tumble::testing;

namespace {

constexpr double radius = 0.0286, mass = 0.17;
constexpr double close_enough = 1e-7;  // m: rounding, after the balls have amplified it

struct Rack {
    int rows = 5;
    double gap = 0.0;  // share of the distance of touching centers
    double speed = 5.0, restitution = 0.93, friction = 0.06;
    bool exact = false;
    double turn = 0.0;  // rad, of the whole scene about the vertical
};

// Ball k of a row, and its mirror image at z = 0.
std::size_t ball(int row, int k) { return std::size_t(2 + row * (row + 1) / 2 + k); }

// The ball that breaks is body 1.
SceneDescription scene_of(const Rack& rack) {
    SceneDescription scene = ground_scene(rack.restitution, rack.friction);
    if (rack.exact) scene.simulation.impacts = ImpactMode::exact;
    const auto add = [&](const Vec3& position) -> BodyDescription& {
        BodyDescription& body = add_sphere(scene, radius, turn(Vec3::UnitY(), rack.turn) * position, mass);
        body.restitution = rack.restitution;
        body.friction = rack.friction;
        return body;
    };
    add({-0.3, radius, 0.0}).velocity = turn(Vec3::UnitY(), rack.turn) * Vec3(rack.speed, 0.0, 0.0);
    const double apart = 2.0 * radius * (1.0 + rack.gap);
    for (int row = 0; row < rack.rows; ++row)
        for (int k = 0; k <= row; ++k) add({row * apart * std::sqrt(0.75), radius, (k - 0.5 * row) * apart});
    return scene;
}

/// The largest distance of a ball's mirror image from the other ball, over the frames.
double asymmetry(const Rack& rack, double seconds) {
    const SceneDescription scene = scene_of(rack);
    World world(scene);
    double most = 0.0;
    for (int frame = 0; frame < int(std::lround(seconds * scene.output.fps)); ++frame) {
        world.advance_frame();
        const Snapshot now = world.snapshot();
        const auto at = [&](int row, int k) -> Vec3 {
            return turn(Vec3::UnitY(), -rack.turn) * now.bodies[ball(row, k)].center_of_mass;
        };
        for (int row = 0; row < rack.rows; ++row)
            for (int k = 0; k <= row; ++k) {
                const Vec3 image = at(row, row - k);
                most = std::max(most, (at(row, k) - Vec3(image.x(), image.y(), -image.z())).norm());
            }
    }
    return most;
}

}  // namespace

TEST(Rack, BouncesAsItsMirrorImage) {
    for (const bool exact : {false, true})
        for (const double gap : {0.0, 5e-4})
            for (const double restitution : {0.5, 0.93})
                EXPECT_LT(asymmetry({.gap = gap, .restitution = restitution, .exact = exact}, 0.8), close_enough)
                    << exact << " " << gap << " " << restitution;
}

TEST(Rack, RollsApartAsItsMirrorImageWithoutRestitution) {
    for (const bool exact : {false, true})
        for (const double gap : {0.0, 5e-4})
            EXPECT_LT(asymmetry({.gap = gap, .restitution = 0.0, .exact = exact}, 0.4), close_enough)
                << exact << " " << gap;
}

// Neither an axis of the world nor a speed is preferred.
TEST(Rack, TurnedAboutTheVertical) {
    for (const bool exact : {false, true})
        for (const double speed : {2.0, 8.0})
            EXPECT_LT(asymmetry({.rows = 4, .speed = speed, .exact = exact, .turn = 0.7}, 0.8), close_enough)
                << exact << " " << speed;
}

}  // namespace tumble::rack_test
