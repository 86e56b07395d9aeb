// Galperin's billiard ("Playing pool with pi", 2003): a heavy body drives a light one, both elastic, against a wall.
// The two positions, times the roots of the masses, are the coordinates of one point that moves straight in a wedge of
// the angle arctan sqrt(m / M) between two mirrors.
#include "exact_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

namespace tumble::billiard_test {
using namespace tumble::testing;

namespace {

constexpr double light_size = 0.1, heavy_size = 0.5;  // m, radii or half edges
constexpr double to_wall = 1.0, between = 0.2;        // m, gaps

BodyDescription& add(SceneDescription& scene, bool boxes, double size, double place, double mass) {
    const Vec3 at(place, 0.0, 0.0);
    BodyDescription& body = boxes ? add_box(scene, Vec3::Constant(2.0 * size), at) : add_sphere(scene, size, at);
    body.mass = mass;
    body.restitution = 1.0;
    return body;
}

SceneDescription walled_scene() {
    SceneDescription scene = empty_scene();
    BodyDescription& wall = add_body(scene, PlaneShape{Vec3::UnitX()}, Vec3::Zero());
    wall.type = BodyType::fixed;
    wall.restitution = 1.0;
    return scene;
}

SceneDescription billiard(bool boxes, ImpactMode impacts, double ratio) {
    SceneDescription scene = walled_scene();
    scene.simulation.impacts = impacts;
    add(scene, boxes, light_size, to_wall + light_size, 1.0);
    add(scene, boxes, heavy_size, to_wall + 2.0 * light_size + between + heavy_size, ratio).velocity = {-1.0, 0.0, 0.0};
    return scene;
}

// Velocities of the light and the heavy body after the last impact. Unfolded, the point continues straight, along the
// wall's mirror, and ends in the last image of the wedge that it reaches: it has passed n mirrors, theta apart. Each
// reflection rotates the direction about its mirror.
struct Velocities {
    double light, heavy;
};
Velocities in_the_end(double ratio) {
    const double theta = std::atan(1.0 / std::sqrt(ratio));
    const double count = std::ceil(std::numbers::pi / theta - 1e-9) - 1.0;
    // In (sqrt(M) V, v) it arrives at the angle pi; the mirror between the two at theta maps a to 2 theta - a, the
    // wall's at 0 maps a to -a.
    const bool odd = std::fmod(count, 2.0) == 1.0;
    const double angle = odd ? (count + 1.0) * theta - std::numbers::pi : std::numbers::pi - count * theta;
    return {std::sqrt(ratio) * std::sin(angle), std::cos(angle)};
}

}  // namespace

// Rounding makes faces meet at negligible angles: these must neither grow from impact to impact nor decide the next
// one.
TEST(Galperin, EndsAsInTheUnfoldedWedge) {
    for (const double ratio : {1.0, 16.0, 100.0, 1e4, 1e6}) {  // 3, 12, 31, 314, 3141 impacts
        const Velocities right = in_the_end(ratio);
        for (const bool boxes : {false, true}) {
            for (const ImpactMode impacts : {ImpactMode::exact, ImpactMode::stepped}) {
                const SceneDescription scene = billiard(boxes, impacts, ratio);
                World world(scene);
                run(world, scene, 20.0);
                const auto bodies = world.snapshot().bodies;
                const auto label = fmt::format("{} {} {}", ratio, boxes ? "boxes" : "balls",
                                               impacts == ImpactMode::exact ? "exact" : "stepped");
                EXPECT_NEAR(bodies[1].velocity.x(), right.light, 1e-9) << label;
                EXPECT_NEAR(bodies[2].velocity.x(), right.heavy, 1e-12) << label;
            }
        }
    }
}

// Faces that meet at an angle far below visibility meet all at once.
TEST(Galperin, ANearlyFlatBoxReboundsFlat) {
    for (const double tilt : {1e-10, 1e-8, 3e-7}) {  // rad
        SceneDescription scene = walled_scene();
        make_exact(scene);
        BodyDescription& box = add(scene, true, light_size, 1.0, 1.0);
        box.velocity = {-1.0, 0.0, 0.0};
        box.rotation = turn(Vec3(0.0, 0.6, 0.8), tilt);
        World world(scene);
        run(world, scene, 2.0);
        EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 1.0, 10.0 * tilt) << tilt;
        EXPECT_LE(world.snapshot().bodies[1].angular_velocity.norm(), 100.0 * tilt) << tilt;
    }
}

}  // namespace tumble::billiard_test
