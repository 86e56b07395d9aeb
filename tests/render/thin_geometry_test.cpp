// Boxes thinner than a pixel: their coverage of each column of pixels, and partial redraw.
#include "drawing.h"
#include "example_scenes.h"
#include "random.h"

#include "render/antialiasing/thin_geometry_aa.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::thin_geometry_test {
namespace {

constexpr double distance = 10.0;

/// Seen straight on, before a white upright ground that reflects no light; without shadows.
SceneDescription before_a_wall() {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 0.0, distance);
    scene.camera.target = Vec3::Zero();
    scene.light.direction = Vec3(0.0, -0.3, -1.0);
    scene.light.shadows = false;
    scene.bodies = {ground_plane({250, 250, 250}, Pattern::plain)};
    scene.bodies[0].rotation = Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitX()));
    scene.bodies[0].position.z() = -30.0;
    return scene;
}

BodyDescription rod(const Vec3& position, double length, double width, double angle) {
    const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    return box_body(position, Vec3(length, width, width), {20, 20, 20}, turn);
}

// The light that a column loses is the rod's coverage of it, w / cos(a) pixels, for any place of the pixel centers.
TEST(ThinGeometry, HaveTheirCoverageOfEachColumn) {
    for (const double width : {0.12, 0.3, 0.6, 0.9})
        for (const double degrees : {0.0, 3.0, 17.0, 44.0}) {
            SceneDescription scene = before_a_wall();
            const Image empty = drawn(scene);
            const double pixel = Camera(scene.camera, scene.output.width, scene.output.height).pixel_size() * distance;
            const double angle = degrees * M_PI / 180.0;
            scene.bodies.push_back(rod(Vec3(0.003, 0.011, 0.0), 200.0 * pixel, width * pixel, angle));
            const Image image = drawn(scene);
            double dark = 255.0;  // the rod's own brightness
            SceneDescription near = scene;
            near.bodies[1] = rod(Vec3::Zero(), 200.0 * pixel, 40.0 * pixel, 0.0);
            dark = brightness(drawn(near), {image.width / 2, image.height / 2});
            double least = 1e9, most = 0.0, sum = 0.0;
            int columns = 0;
            for (int x = image.width / 2 - 60; x < image.width / 2 + 60; ++x, ++columns) {
                double lost = 0.0;
                for (int y = 0; y < image.height; ++y) lost += brightness(empty, {x, y}) - brightness(image, {x, y});
                const double share = lost / (brightness(empty, {x, image.height / 2}) - dark);
                least = std::min(least, share);
                most = std::max(most, share);
                sum += share;
            }
            const double wanted = width / std::cos(angle);
            EXPECT_NEAR(sum / columns, wanted, 0.03 + 0.05 * wanted) << width << " pixels, " << degrees << " degrees";
            EXPECT_GT(least, 0.85 * wanted - 0.03) << width << " pixels, " << degrees << " degrees";
            EXPECT_LT(most, 1.15 * wanted + 0.03) << width << " pixels, " << degrees << " degrees";
        }
}

TEST(ThinGeometry, AreHiddenByBodiesInFrontOfThem) {
    SceneDescription scene = before_a_wall();
    scene.bodies.push_back(box_body(Vec3(0.0, 0.0, 1.0), Vec3(2.0, 2.0, 0.2), {200, 60, 60}));
    const Image without = drawn(scene);
    scene.bodies.push_back(rod(Vec3::Zero(), 6.0, 0.01, 0.2));
    const Image with = drawn(scene);
    const Camera view(scene.camera, scene.output.width, scene.output.height);
    for (double x = -0.9; x < 0.9; x += 0.02) {
        const Pixel at = pixel_of(scene, Vec3(x, std::tan(0.2) * x, 1.1));
        EXPECT_EQ(brightness(with, at), brightness(without, at)) << x;
    }
    EXPECT_LT(brightness_at(with, scene, Vec3(2.0, 2.0 * std::tan(0.2), 0.0)) + 10.0,
              brightness_at(without, scene, Vec3(2.0, 2.0 * std::tan(0.2), 0.0)));
}

// Specks come in crowds, which leave no visible background beside a rod.
TEST(ThinGeometry, AreLongAndThin) {
    EXPECT_TRUE(is_rod(Vec3(0.3, 20.0, 0.01)));
    EXPECT_FALSE(is_rod(Vec3(0.3, 0.3, 0.3))) << "a speck";
    EXPECT_FALSE(is_rod(Vec3(0.3, 20.0, 20.0))) << "a card";
    EXPECT_FALSE(is_rod(Vec3(1.0, 20.0, 1.0))) << "two pixels wide";
}

TEST(ThinGeometry, PartialRedrawHasTheBytesOfAFullRedraw) {
    RenderSwitches everything;
    everything.full_redraw = true;
    for (unsigned seed = 0; seed < 12; ++seed) {
        Random random(seed);
        SceneDescription scene = empty_scene();
        scene.output.width = 232;
        scene.output.height = 152;
        scene.camera.eye = Vec3(1.0, 3.0, 8.0);
        scene.bodies = {ground_plane({190, 190, 190}, seed % 2 == 0 ? Pattern::grid : Pattern::plain)};
        for (int i = 0; i < 12; ++i) {
            const double width = std::pow(10.0, random.between(-2.5, -1.2));
            scene.bodies.push_back(
                i % 4 == 3
                    ? box_body(Vec3::Zero(), Vec3(0.5, 0.4, 0.6), random.color())
                    : box_body(Vec3::Zero(), Vec3(random.between(0.0, 3.0) + width, width, width), random.color()));
            scene.bodies.back().position = random.vector(2.0, 0.8, 2.0) + Vec3(0.0, 1.0, 0.0);
            scene.bodies.back().rotation = random.turn();
        }
        Renderer partial(scene), full(scene, everything);
        Snapshot snapshot = first_snapshot(scene);
        for (int step = 0; step < 16; ++step) {
            ASSERT_TRUE(partial.render(snapshot) == full.render(snapshot)) << "scene " << seed << ", step " << step;
            for (std::size_t i = 1; i < snapshot.bodies.size(); ++i) {
                if (!random.chance(0.2)) continue;
                snapshot.bodies[i].origin += random.vector(std::pow(10.0, random.between(-3.0, 0.0)));
                if (random.chance(0.5)) snapshot.bodies[i].orientation = random.turn();
            }
        }
    }
}

}  // namespace
}  // namespace tumble::thin_geometry_test
