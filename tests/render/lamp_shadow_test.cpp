// Shadows of a second light: a sun or a spot.
#include "drawing.h"
#include "example_scenes.h"
#include "random.h"

#include <gtest/gtest.h>

namespace tumble::lamp_shadow_test {
namespace {

/// A box 1 m above the ground, below a sun straight above and a second light from the left.
SceneDescription two_lights(LightType type) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 6.0, 9.0);
    scene.camera.target = Vec3(1.0, 0.5, 0.0);
    scene.bodies = {ground_plane({200, 200, 200}, Pattern::plain),
                    box_body(Vec3(0.0, 1.5, 0.0), Vec3::Ones(), {200, 200, 200})};
    LampDescription sun;
    sun.direction = Vec3(0.0, -1.0, 0.0);
    sun.intensity = 0.5;
    sun.shadows = true;
    LampDescription second;
    second.type = type;
    second.direction = Vec3(1.0, -1.0, 0.0).normalized();
    second.position = Vec3(-3.0, 4.5, 0.0);
    second.intensity = type == LightType::sun ? 0.5 : 25.0;
    second.angle = 70.0;
    second.shadows = true;
    scene.lamps = {sun, second};
    scene.light.direction = sun.direction;
    return scene;
}

const Vec3 below_box(0.0, 0.0, 0.0), beside_box(1.5, 0.0, 0.0), in_the_open(1.5, 0.0, 1.6);

TEST(LampShadow, IsWhereTheSecondLightDoesNotReach) {
    for (const LightType type : {LightType::sun, LightType::spot}) {
        SceneDescription scene = two_lights(type);
        const Image both = drawn(scene);
        scene.lamps[1].shadows = false;
        const Image one = drawn(scene);
        EXPECT_LT(brightness_at(both, scene, beside_box), brightness_at(one, scene, beside_box) - 15.0);
        EXPECT_NEAR(brightness_at(both, scene, in_the_open), brightness_at(one, scene, in_the_open), 1.0);
        EXPECT_NEAR(brightness_at(both, scene, below_box), brightness_at(one, scene, below_box), 1.0)
            << "lit by the second light alone";
        scene.lamps[1].intensity = 0.0;
        EXPECT_NEAR(brightness_at(both, scene, beside_box), brightness_at(drawn(scene), scene, beside_box), 1.0)
            << "the sun alone";
    }
}

/// Neither light has specks of shadow on the faces that it lights.
TEST(LampShadow, FacesDoNotShadowThemselves) {
    for (const LightType type : {LightType::sun, LightType::spot}) {
        SceneDescription scene = two_lights(type);
        scene.bodies.push_back(ball_body(Vec3(1.5, 0.5, 2.0), 0.5, {200, 200, 200}));
        const Image with = drawn(scene);
        scene.lamps[1].shadows = false;
        const Image without = drawn(scene);
        for (double x = -0.4; x <= 0.4; x += 0.05)
            for (double z = -0.4; z <= 0.4; z += 0.05)
                EXPECT_NEAR(brightness_at(with, scene, Vec3(x, 2.0, z)), brightness_at(without, scene, Vec3(x, 2.0, z)),
                            1.0);
        EXPECT_NEAR(brightness_at(with, scene, Vec3(1.3, 0.9, 2.2)), brightness_at(without, scene, Vec3(1.3, 0.9, 2.2)),
                    1.0);
    }
}

TEST(LampShadow, HasTheBytesOfAFullRedraw) {
    for (const LightType type : {LightType::sun, LightType::spot}) {
        SceneDescription scene = two_lights(type);
        scene.bodies.push_back(mesh_body(Vec3(1.5, 0.5, 1.0), torus_asset(0.5, 0.2), {180, 80, 60}));
        scene.bodies.push_back(ball_body(Vec3(-1.0, 0.4, 1.0), 0.4, {80, 120, 180}));
        RenderSwitches everything;
        everything.full_redraw = true;
        Renderer partial(scene), full(scene, everything);
        Snapshot snapshot = first_snapshot(scene);
        Random random(3);
        for (int i = 0; i < 8; ++i) {
            EXPECT_EQ(partial.render(snapshot), full.render(snapshot)) << "frame " << i;
            snapshot.bodies[1 + std::size_t(i) % 3].origin += random.vector(0.3);
        }
    }
}

/// All that a plane's shader can have at once fits.
TEST(LampShadow, GoesWithAllElse) {
    SceneDescription scene = two_lights(LightType::spot);
    scene.lamps.insert(scene.lamps.end(), 2, scene.lamps[1]);
    scene.lamps[2].shadows = scene.lamps[3].shadows = false;
    scene.environment.emplace();
    scene.environment->background = BackgroundKind::colors;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            BodyDescription wall = ground_plane({190, 150, 140}, Pattern::checker);
            wall.shape = PlaneShape{side * Vec3::Unit(axis), -30.0};
            scene.bodies.push_back(wall);
        }
    EXPECT_GT(brightness_at(drawn(scene), scene, in_the_open), 0.0);
}

}  // namespace
}  // namespace tumble::lamp_shadow_test
