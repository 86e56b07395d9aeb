// Environments in frames: even light on all materials, backgrounds without a seam, tone and exposure.
#include "drawing.h"
#include "example_scenes.h"

#include "core/deterministic_math.h"
#include "scene/environment/presets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tumble::environment_test {
namespace {

EnvironmentDescription even_light(float light) {
    EnvironmentDescription environment;
    environment.image = std::make_shared<EnvironmentImage>(
        EnvironmentImage{16, 8, std::vector<std::array<float, 3>>(16 * 8, {light, light, light})});
    environment.background = BackgroundKind::image;
    return environment;
}

EnvironmentDescription preset(std::string_view name) {
    EnvironmentDescription environment;
    environment.image = environment_preset(name).image;
    environment.background = BackgroundKind::image;
    return environment;
}

/// A ball in even light, without the sun: it shines from below an invisible ground.
SceneDescription furnace(const Appearance& look) {
    SceneDescription scene = empty_scene();
    scene.output.width = scene.output.height = 96;
    scene.output.tone = ToneCurve::linear;
    scene.environment = even_light(0.5f);
    scene.camera.eye = Vec3(0.0, 1.0, 4.0);
    scene.bodies = {ground_plane(), ball_body(Vec3(0.0, 1.0, 0.0), 1.0, {255, 255, 255})};
    scene.bodies[0].appearance.visible = false;
    std::get<PlaneShape>(scene.bodies[0].shape).offset = -1000.0;
    const Color color = scene.bodies[1].appearance.color;
    scene.bodies[1].appearance = look;
    scene.bodies[1].appearance.color = color;
    scene.bodies[1].appearance.pattern = Pattern::plain;
    scene.light.direction = Vec3(0.0, 1.0, 0.0);
    return scene;
}

TEST(Environment, AWhiteBallVanishesInEvenLight) {
    const int white = int(std::lround(255.0 * linear_to_srgb(0.5)));
    for (const double roughness : {0.0, 0.3, 0.6, 1.0}) {
        Appearance look;
        look.roughness = roughness;
        const Image image = drawn(furnace(look));
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(image.at(x, y)[c], white, 1) << roughness << " " << x << " " << y;
    }
}

TEST(Environment, WhiteMetalReturnsNineTenthsOfEvenLight) {
    for (const double roughness : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
        Appearance look;
        look.roughness = roughness;
        look.metallic = 1.0;
        const Image image = drawn(furnace(look));
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                ASSERT_GE(srgb_to_linear(image.at(x, y)[1] / 255.0), 0.9 * 0.5) << roughness << " " << x << " " << y;
    }
}

/// Dark ground below a background.
SceneDescription dark_ground(const EnvironmentDescription& environment) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 1.0, 8.0);
    scene.camera.target = Vec3(0.0, 1.2, 0.0);
    scene.bodies = {ground_plane({24, 24, 26}, Pattern::plain), ball_body(Vec3(0.0, 0.5, 0.0), 0.5, {200, 60, 40})};
    scene.environment = environment;
    return scene;
}

TEST(Environment, NoBackgroundHasASeamAtTheHorizon) {
    EnvironmentDescription dark, gradient;
    dark.background = gradient.background = BackgroundKind::colors;
    dark.low = dark.high = {16, 18, 20};
    gradient.low = {220, 200, 170}, gradient.high = {40, 60, 120};
    for (const EnvironmentDescription& environment :
         {dark, gradient, preset("studio"), preset("overcast"), preset("dusk")}) {
        const Image image = drawn(dark_ground(environment));
        const int x = 20;
        for (int y = 1; y < image.height; ++y)
            for (int c = 0; c < 3; ++c) ASSERT_LE(std::abs(image.at(x, y)[c] - image.at(x, y - 1)[c]), 24) << y;
    }
}

TEST(Environment, AColorIsThatOfTheScreen) {
    EnvironmentDescription plain;
    plain.background = BackgroundKind::colors;
    plain.low = plain.high = {0x20, 0x50, 0x90};
    SceneDescription scene = dark_ground(plain);
    scene.output.tone = ToneCurve::linear;
    const Image image = drawn(scene);
    EXPECT_NEAR(image.at(10, 5)[0], 0x20, 1);
    EXPECT_NEAR(image.at(10, 5)[1], 0x50, 1);
    EXPECT_NEAR(image.at(10, 5)[2], 0x90, 1);
    scene.output.exposure = 1.0;
    EXPECT_NEAR(srgb_to_linear(drawn(scene).at(10, 5)[2] / 255.0), 2.0 * srgb_to_linear(0x90 / 255.0), 0.01);
}

/// The pixels of both renderings are the same over some frames in which a box and a ball move.
void expect_partial_redraw(SceneDescription scene, RenderSwitches switches, const char* name) {
    scene.bodies.push_back(box_body(Vec3(1.0, 0.5, 0.0), Vec3(1.0, 1.0, 1.0), {90, 140, 200}));
    scene.bodies.push_back(ball_body(Vec3(-1.2, 0.4, 1.0), 0.4, {220, 220, 220}));
    scene.bodies.back().appearance.metallic = 1.0;
    scene.bodies.back().appearance.roughness = 0.1;
    RenderSwitches whole = switches;
    whole.full_redraw = true;
    Renderer partial(scene, switches), full(scene, whole);
    Snapshot snapshot = first_snapshot(scene);
    for (int frame = 0; frame < 5; ++frame) {
        EXPECT_TRUE(partial.render(snapshot) == full.render(snapshot)) << name << " " << frame;
        if (frame == 3) {
            snapshot.bodies[3].origin.y() += 1.0;
            continue;
        }
        snapshot.bodies[2].origin += Vec3(0.07, 0.03, -0.02);
        snapshot.bodies[2].orientation = Quat(Eigen::AngleAxisd(0.1 * frame, Vec3(1.0, 2.0, 3.0).normalized()));
    }
}

SceneDescription with_shadows_only() {
    SceneDescription scene = dark_ground(preset("studio"));
    scene.environment->ground_shadow = true;
    return scene;
}

TEST(Environment, PartialRedrawHasTheBytesOfAFullOne) {
    expect_partial_redraw(dark_ground(preset("studio")), {}, "studio");
    expect_partial_redraw(dark_ground(preset("dusk")), {}, "dusk");
    SceneDescription mirror = dark_ground(preset("studio"));
    mirror.bodies[0].appearance.reflection = 0.4;
    expect_partial_redraw(mirror, {}, "mirror");
    mirror.output.samples = 1;
    expect_partial_redraw(mirror, {}, "mirror, one sample");
    expect_partial_redraw(with_shadows_only(), {}, "shadows");
    RenderSwitches transparent;
    transparent.transparent = true;
    expect_partial_redraw(with_shadows_only(), transparent, "transparent shadows");
}

TEST(Mirror, ShowsABallBelowItselfAndNothingElse) {
    SceneDescription scene = dark_ground(preset("studio"));
    scene.camera.up = Vec3(0.1, 1.0, 0.0);
    const Image plain = drawn(scene);
    scene.bodies[0].appearance.reflection = 0.5;
    const Image mirrored = drawn(scene);
    const Pixel below = pixel_of(scene, Vec3(0.0, -0.5, 0.0)), beside = pixel_of(scene, Vec3(-2.0, -0.5, 0.0));
    EXPECT_GT(mirrored.at(below.x, below.y)[0], plain.at(below.x, below.y)[0] + 20);  // the ball is red
    for (int c = 0; c < 4; ++c) EXPECT_EQ(mirrored.at(beside.x, beside.y)[c], plain.at(beside.x, beside.y)[c]);
}

// By the color of the floor and by the sky that it mirrors: the image shows undersides.
TEST(Mirror, LightsUndersides) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 0.3, 4.0);
    scene.camera.target = Vec3(0.0, 1.5, 0.0);
    scene.bodies = {ground_plane({0xd0, 0xd0, 0xd0}),
                    box_body(Vec3(0.0, 2.0, 0.0), Vec3(0.6, 0.1, 0.6), {0xf0, 0xf0, 0xf0})};
    const Pixel seen = pixel_of(scene, Vec3(0.0, 1.9, 0.0));
    const int plain = drawn(scene).at(seen.x, seen.y)[1];
    scene.bodies[0].appearance.reflection = 0.3;
    EXPECT_GT(drawn(scene).at(seen.x, seen.y)[1], plain + 20);
}

TEST(GroundShadow, IsTheOnlyThingThatShowsOfThePlane) {
    SceneDescription scene = with_shadows_only();
    scene.light.direction = Vec3(-1.2, -1.0, 0.2);  // the shadow is beside the ball
    RenderSwitches transparent;
    transparent.transparent = true;
    const Image image = drawn(scene, transparent);
    const Vec3 sunward = -scene.light.direction.normalized();
    const Pixel shadow = pixel_of(scene, Vec3(0.0, 0.5, 0.0) - sunward * (0.5 / sunward.y()));
    const std::uint8_t* pixel = image.at(shadow.x, shadow.y);
    EXPECT_GT(pixel[3], 40);
    EXPECT_LT(pixel[3], 220);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(pixel[c], 0);
    EXPECT_EQ(image.at(8, image.height - 4)[3], 0);  // ground without a shadow
    EXPECT_EQ(image.at(8, 4)[3], 0);
    const Pixel ball = pixel_of(scene, Vec3(0.0, 0.5, 0.5));
    EXPECT_EQ(image.at(ball.x, ball.y)[3], 255);
}

}  // namespace
}  // namespace tumble::environment_test
