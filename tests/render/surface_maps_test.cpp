// Normal, roughness and emission maps, opacity, emission, holes, and several lights.
#include "drawing.h"
#include "example_scenes.h"

#include "core/deterministic_math.h"
#include "render/aov/aov_renderer.h"
#include "scene/description/looks.h"
#include "scene/mesh/texture_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::surface_maps_test {
namespace {

constexpr int side = 96;  // pixels of a frame
constexpr double distance = 12.0;

std::shared_ptr<const Texture> map_of(int size, const auto& texel_at) {
    Texture image;
    image.levels.push_back({size, size, {}});
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) image.levels[0].texels.push_back(texel_at(x, y));
    return changed_map(image, [](int, int, auto&) {});
}

std::uint8_t direction_code(double v) { return std::uint8_t(std::lround(128.0 + 127.0 * v)); }

/// Looks straight at a body of 1 m in the origin.
SceneDescription front_view(BodyDescription body, const Vec3& light) {
    SceneDescription scene = empty_scene();
    scene.output.width = scene.output.height = side;
    scene.output.samples = 1;
    scene.camera.eye = Vec3(0.0, 0.0, distance + 0.5);
    scene.camera.target = Vec3::Zero();
    scene.camera.vertical_fov = 360.0 / pi * std::atan(0.5 * 1.2 / distance);
    scene.light.direction = light;
    scene.light.shadows = false;
    body.position = Vec3::Zero();
    scene.bodies = {std::move(body)};
    return scene;
}

BodyDescription matte(BodyDescription body) {
    body.appearance.pattern = Pattern::plain;
    body.appearance.roughness = 1.0;
    return body;
}

BodyDescription cube(Color color = {120, 120, 120}) { return matte(box_body(Vec3::Zero(), Vec3::Ones(), color)); }

double level(const Image& image, int x, int y, std::size_t channel = 1) { return image.at(x, y)[channel]; }

double linear(double level) { return srgb_to_linear(level / 255.0); }

/// A place on the front of the cube, from -0.5 to 0.5 m, as a pixel.
int pixel_at(double m) { return int(std::floor(side * (0.5 + m / 1.2))); }

TEST(NormalMap, ShowsTheBumpsThatItDescribes) {
    constexpr double radius = 0.45;
    const auto bump = map_of(512, [&](int x, int y) -> std::array<std::uint8_t, 4> {
        const double u = ((x + 0.5) / 512 - 0.5) / radius, v = (0.5 - (y + 0.5) / 512) / radius;
        const double rest = 1.0 - u * u - v * v;
        if (rest <= 0.0) return {128, 128, 255, 255};
        return {direction_code(u), direction_code(v), direction_code(std::sqrt(rest)), 255};
    });
    BodyDescription mapped = cube();
    mapped.appearance.normal_map = bump;
    double sum = 0.0, contrast = 0.0;
    int count = 0;
    for (const Vec3& light : {Vec3(-1.0, -0.2, -1.0), Vec3(0.6, -0.9, -1.0), Vec3(0.5, 0.7, -1.0)}) {
        const Image real = drawn(front_view(matte(ball_body(Vec3::Zero(), radius, {120, 120, 120})), light));
        const Image flat = drawn(front_view(cube(), light));
        const Image shown = drawn(front_view(mapped, light));
        for (double y = -0.3; y <= 0.3; y += 0.02)
            for (double x = -0.3; x <= 0.3; x += 0.02) {
                if (x * x + y * y > 0.09) continue;
                const int i = pixel_at(x), j = pixel_at(-y);
                sum += std::abs(level(real, i, j) - level(shown, i, j));
                contrast += std::abs(level(real, i, j) - level(flat, i, j));
                ++count;
            }
    }
    EXPECT_LT(sum / count, 1.0);       // a degree of the normal is about a level
    EXPECT_GT(contrast / count, 5.0);  // the bump is visible
}

TEST(NormalMap, AFlatOneChangesNothing) {
    const auto flat = map_of(4, [](int, int) { return std::array<std::uint8_t, 4>{128, 128, 255, 255}; });
    for (BodyDescription body : {cube(), matte(ball_body(Vec3::Zero(), 0.5, {120, 90, 60}))}) {
        const Image plain = drawn(front_view(body, Vec3(-0.5, -0.7, -1.0)));
        body.appearance.normal_map = flat;
        const Image mapped = drawn(front_view(body, Vec3(-0.5, -0.7, -1.0)));
        for (int y = 20; y < 76; ++y)
            for (int x = 20; x < 76; ++x) EXPECT_NEAR(level(plain, x, y), level(mapped, x, y), 1.0) << x << " " << y;
    }
}

TEST(RoughnessMap, OfOneValueIsThatRoughness) {
    const auto half = map_of(2, [](int, int) { return std::array<std::uint8_t, 4>{255, 102, 255, 255}; });
    BodyDescription body = cube();
    body.appearance.metallic = 1.0;
    body.appearance.roughness = 0.4;
    const Vec3 light(-0.2, -0.2, -1.0);
    const Image plain = drawn(front_view(body, light));
    body.appearance.roughness = 1.0;
    const Image rough = drawn(front_view(body, light));
    body.appearance.roughness_map = half;
    const Image mapped = drawn(front_view(body, light));
    EXPECT_NEAR(level(plain, 48, 48), level(mapped, 48, 48), 1.0);
    EXPECT_GT(std::abs(level(plain, 48, 48) - level(rough, 48, 48)), 5.0);
}

TEST(Opacity, MixesABodyWithTheBackground) {
    SceneDescription scene = front_view(cube({40, 40, 220}), Vec3(-0.2, -0.2, -1.0));
    scene.camera.eye = Vec3(0.0, 0.0, 6.0);
    const auto shown = [&](double opacity, bool with_front) {
        SceneDescription one = scene;
        BodyDescription front = matte(ball_body(Vec3(0.1, 0.0, 2.0), 0.2, {220, 30, 30}));
        front.appearance.opacity = opacity;
        if (with_front) one.bodies.push_back(front);
        const Image image = drawn(one);
        const Pixel at = pixel_of(one, Vec3(0.1, 0.0, 2.0));
        return std::array{level(image, at.x, at.y, 0), level(image, at.x, at.y, 2)};
    };
    const auto behind = shown(1.0, false), alone = shown(1.0, true), mixed = shown(0.25, true);
    for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(mixed[c], 0.75 * behind[c] + 0.25 * alone[c], 1.0);
}

/// The farther one is drawn first, in any order of the scene.
TEST(Opacity, LayersLieInTheOrderOfTheirDepth) {
    const auto shown = [&](bool swapped) {
        SceneDescription scene = front_view(cube(), Vec3(-0.2, -0.2, -1.0));
        BodyDescription near = matte(ball_body(Vec3(0.0, 0.0, 3.0), 0.2, {220, 30, 30}));
        BodyDescription far = matte(ball_body(Vec3(0.0, 0.0, 1.5), 0.2, {30, 220, 30}));
        near.appearance.opacity = far.appearance.opacity = 0.5;
        scene.bodies.push_back(swapped ? far : near);
        scene.bodies.push_back(swapped ? near : far);
        const Image image = drawn(scene);
        return std::array{level(image, 48, 48, 0), level(image, 48, 48, 1)};
    };
    EXPECT_EQ(shown(false), shown(true));
    EXPECT_GT(shown(false)[0], shown(false)[1]);
}

TEST(Opacity, ThinsTheShadow) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 3.0, 6.0);
    scene.camera.target = Vec3::Zero();
    scene.light.direction = Vec3(0.0, -1.0, 0.0);
    scene.bodies = {ground_plane({200, 200, 200}, Pattern::plain),
                    box_body(Vec3(0.0, 2.2, 0.0), Vec3(1.2, 0.1, 1.2), {200, 0, 0})};
    const auto ground = [&](double opacity, bool shadows) {
        scene.bodies[1].appearance.opacity = opacity;
        scene.light.shadows = shadows;
        return brightness_at(drawn(scene), scene, Vec3(0.0, 0.0, 0.3));
    };
    const double lit = linear(ground(1.0, false)), dark = linear(ground(1.0, true)),
                 half = linear(ground(5.0 / 9.0, true));
    EXPECT_LT(dark, 0.7 * lit);
    EXPECT_NEAR((half - dark) / (lit - dark), 4.0 / 9.0, 0.1);
}

TEST(Opacity, PartialRedrawIsFullRedraw) {
    SceneDescription scene = empty_scene();
    scene.bodies = {ground_plane(), box_body(Vec3(-1.0, 0.5, 0.0), Vec3::Ones(), {60, 90, 220}),
                    ball_body(Vec3(0.3, 0.5, 0.5), 0.5, {220, 90, 40}),
                    ball_body(Vec3(0.2, 0.4, -1.2), 0.4, {40, 160, 60})};
    scene.bodies[1].appearance.opacity = 0.4;
    scene.bodies[2].appearance.opacity = 0.6;
    scene.bodies[2].appearance.emission = {40, 0, 0};
    RenderSwitches whole;
    whole.full_redraw = true;
    Renderer part(scene), all(scene, whole);
    Snapshot snapshot = first_snapshot(scene);
    for (int i = 0; i < 8; ++i) {
        snapshot.bodies[i % 3 + 1].origin += Vec3(0.07, 0.02, -0.04 * (i % 2));
        EXPECT_EQ(part.render(snapshot).pixels, all.render(snapshot).pixels) << i;
    }
}

TEST(Emission, NeedsNoLight) {
    SceneDescription scene = front_view(cube({0, 0, 0}), Vec3(0.0, 0.0, 1.0));
    scene.bodies[0].appearance.emission = {180, 120, 60};
    const Image image = drawn(scene);
    EXPECT_NEAR(level(image, 48, 48, 0), 180.0, 8.0);  // with the gloss of the black surface
    EXPECT_NEAR(level(image, 48, 48, 1), 120.0, 8.0);
    EXPECT_NEAR(level(image, 48, 48, 2), 60.0, 14.0);
}

/// A square that faces +z, its left half a hole.
SceneDescription with_holes() {
    auto asset = std::make_shared<MeshAsset>();
    for (const auto& [x, y] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
        asset->mesh.vertices.push_back(Vec3(x, y, 0.0));
        asset->vertices.push_back({{float(x), float(y), 0.0f}, {0.0f, 0.0f, 1.0f}});
    }
    asset->mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    asset->indices = {0, 1, 2, 0, 2, 3};
    auto paint = std::make_shared<MeshPaint>();
    MeshMaterial material;
    auto texture = std::make_shared<Texture>();
    texture->levels.push_back({2, 1, {{200, 200, 200, 0}, {200, 200, 200, 255}}});
    texture->levels.push_back({1, 1, {{200, 200, 200, 128}}});
    texture->least_alpha = 0;
    material.texture = texture;
    material.wrap_u = material.wrap_v = TextureWrap::clamp;
    material.nearest = true;
    material.cutoff = 0.5f;
    paint->materials = {material};
    paint->material_of_triangle = {0, 0};
    for (const std::uint32_t i : asset->indices) {
        const auto& at = asset->vertices[i].position;
        paint->corners.push_back({{at[0] + 0.5f, 0.5f - at[1]}, {1.0f, 1.0f, 1.0f}});
    }
    asset->paint = paint;
    SceneDescription scene = front_view(mesh_body(Vec3::Zero(), asset, {200, 200, 200}), Vec3(0.0, 0.0, -1.0));
    std::get<MeshShape>(scene.bodies[0].shape).painted = true;
    BodyDescription wall = ground_plane({200, 200, 200}, Pattern::plain);
    wall.shape = PlaneShape{Vec3::UnitZ(), -0.5};
    scene.bodies.push_back(wall);
    return scene;
}

TEST(Holes, AreOpenInAovs) {
    const SceneDescription scene = with_holes();
    AovSet set;
    set.add(Aov::segmentation);
    AovRenderer renderer(scene, set);
    const auto& ids = renderer.make({first_snapshot(scene), {}}).segmentation;
    EXPECT_EQ(ids[std::size_t(48 * side + 30)], 2);
    EXPECT_EQ(ids[std::size_t(48 * side + 66)], 1);
}

TEST(Holes, LetTheSunThrough) {
    SceneDescription scene = with_holes();
    scene.light.shadows = true;
    scene.light.direction = Vec3(0.0, -0.6, -1.0);
    scene.camera.eye = Vec3(0.0, -3.0, 6.0);
    scene.camera.vertical_fov = 30.0;
    const Image image = drawn(scene);
    const Vec3 shift(0.0, -0.3, -0.5);  // along the light to the wall
    const double behind_hole = brightness_at(image, scene, Vec3(-0.25, -0.4, 0.0) + shift);
    const double behind_sheet = brightness_at(image, scene, Vec3(0.25, -0.4, 0.0) + shift);
    EXPECT_GT(behind_hole, behind_sheet + 20.0);
}

SceneDescription lit_by(std::vector<LampDescription> lamps) {
    SceneDescription scene = front_view(cube({120, 120, 120}), Vec3(0.0, 0.0, -1.0));
    scene.lamps = std::move(lamps);
    return scene;
}

LampDescription sun(const Vec3& direction, double intensity) {
    LampDescription lamp;
    lamp.direction = direction.normalized();
    lamp.intensity = intensity;
    return lamp;
}

TEST(Lights, TwoSunsAddUp) {
    const LampDescription a = sun({-0.5, -0.4, -1.0}, 0.5), b = sun({0.8, -0.2, -0.7}, 0.7);
    const auto frame = [](std::vector<LampDescription> lamps) {
        SceneDescription scene = lit_by(std::move(lamps));
        if (!scene.lamps.empty()) scene.light.direction = scene.lamps.front().direction;
        return drawn(scene);
    };
    LampDescription none = a;
    none.intensity = 0.0;
    const Image dark = frame({none}), first = frame({a}), second = frame({b}), both = frame({a, b});
    for (std::size_t c = 0; c < 3; ++c) {
        const double sum =
            linear(level(first, 48, 48, c)) + linear(level(second, 48, 48, c)) - linear(level(dark, 48, 48, c));
        EXPECT_NEAR(255.0 * linear_to_srgb(sum), level(both, 48, 48, c), 2.0);
        EXPECT_GT(level(both, 48, 48, c), level(first, 48, 48, c) + 10.0);
    }
}

TEST(Lights, APointFallsOffWithTheSquareOfTheDistance) {
    const auto light_at = [](double away, LightType type, double intensity) {
        LampDescription lamp;
        lamp.type = type;
        lamp.position = Vec3(0.0, 0.0, 0.5 + away);
        lamp.direction = Vec3(0.0, 0.0, -1.0);
        lamp.intensity = intensity;
        lamp.angle = 60.0;
        SceneDescription scene = lit_by({lamp});
        scene.bodies[0].appearance.color = {220, 220, 220};
        return linear(level(drawn(scene), 48, 48));
    };
    for (const LightType type : {LightType::point, LightType::spot}) {
        // Each about as bright as the others, so that the levels tell 1 %.
        const double none = light_at(1.0, type, 0.0);
        const double at_one = light_at(1.0, type, 0.4) - none, at_two = light_at(2.0, type, 1.6) - none;
        EXPECT_GT(at_one, 0.1);
        EXPECT_NEAR(at_two / at_one, 1.0, 0.03);
    }
}

TEST(Lights, ASpotEndsAtItsCone) {
    LampDescription spot;
    spot.type = LightType::spot;
    spot.position = Vec3(0.0, 0.0, 1.5);
    spot.direction = Vec3(0.0, 0.0, -1.0);
    spot.angle = 30.0;  // 0.27 m around the middle
    const Image lit = drawn(lit_by({spot}));
    spot.intensity = 0.0;
    const Image dark = drawn(lit_by({spot}));
    EXPECT_GT(level(lit, pixel_at(0.1), 48), level(dark, pixel_at(0.1), 48) + 20.0);
    EXPECT_NEAR(level(lit, pixel_at(0.3), 48), level(dark, pixel_at(0.3), 48), 1.0);
}

}  // namespace
}  // namespace tumble::surface_maps_test
