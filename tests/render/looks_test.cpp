// Patterns and textures: texels seen straight, means from afar, places on shapes in frames and in the albedo AOV.
#include "drawing.h"
#include "example_scenes.h"

#include "core/deterministic_math.h"
#include "output/png_writer.h"
#include "render/aov/aov_renderer.h"
#include "scene/description/looks.h"
#include "scene/mesh/texture_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::looks_test {
namespace {

constexpr Color red{200, 40, 20}, blue{30, 60, 210};
constexpr int side = 96;  // pixels of a frame
constexpr double distance = 5.0;

std::shared_ptr<const Texture> texture_of(int width, int height, const auto& color_at) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Color color = color_at(x, y);
            const std::uint8_t bytes[] = {color.r, color.g, color.b, 255};
            std::copy_n(bytes, 4, image.at(x, y));
        }
    PngEncoder encoder;
    const auto bytes = encoder.encode(image);
    std::int64_t texels = 0;
    return make_texture({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "", texels);
}

std::shared_ptr<const Texture> checker(int cells) {
    return texture_of(cells, cells, [](int x, int y) { return (x + y) % 2 == 0 ? red : blue; });
}

/// Looks straight at a body in the origin: `pixels` to a meter on its front, which is at z = front.
SceneDescription front_view(BodyDescription body, double pixels, double front) {
    SceneDescription scene = empty_scene();
    scene.output.width = scene.output.height = side;
    scene.output.samples = 1;
    scene.camera.eye = Vec3(0.0, 0.0, distance + front);
    scene.camera.target = Vec3::Zero();
    scene.camera.vertical_fov = 360.0 / pi * std::atan(0.5 * side / pixels / distance);
    scene.light.direction = Vec3(0.3, -0.4, -1.0);
    body.position = Vec3::Zero();
    scene.bodies = {std::move(body)};
    return scene;
}

BodyDescription cube(Color color, Pattern pattern = Pattern::plain) {
    BodyDescription body = box_body(Vec3::Zero(), Vec3::Ones(), color);
    body.appearance.pattern = pattern;
    return body;
}

BodyDescription textured(BodyDescription body, std::shared_ptr<const Texture> texture, double scale = 0.0,
                         TextureFilter filter = TextureFilter::linear) {
    body.appearance.color = {255, 255, 255};
    body.appearance.pattern = Pattern::plain;
    body.appearance.texture = std::move(texture);
    body.appearance.texture_scale = scale;
    body.appearance.texture_filter = filter;
    return body;
}

int difference(const std::uint8_t* a, const std::uint8_t* b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

int difference(const std::uint8_t* a, Color b) {
    const std::uint8_t bytes[] = {b.r, b.g, b.b};
    return difference(a, bytes);
}

Color mean_of(Color a, Color b) {
    const auto la = to_linear(a), lb = to_linear(b);
    std::array<std::uint8_t, 3> mean{};
    for (std::size_t c = 0; c < 3; ++c)
        mean[c] = std::uint8_t(std::lround(255.0 * linear_to_srgb(0.5 * (la[c] + lb[c]))));
    return {mean[0], mean[1], mean[2]};
}

std::vector<std::uint8_t> albedo_of(const SceneDescription& scene) {
    AovSet set;
    set.add(Aov::albedo);
    AovRenderer renderer(scene, set);
    return renderer.make({first_snapshot(scene), {}}).albedo;
}

/// All pixels of the middle half of the frame.
template <class Visit>
void visit_middle(const Visit& visit) {
    for (int y = side / 4; y < 3 * side / 4; ++y)
        for (int x = side / 4; x < 3 * side / 4; ++x) visit(x, y);
}

TEST(Plain, ABoxHasOneColorAndAPanelHasAGroove) {
    const auto levels = [](Pattern pattern) {
        const Image image = drawn(front_view(cube({200, 150, 90}, pattern), 80.0, 0.5));
        int least = 255, most = 0;
        for (int x = 14; x < side - 14; ++x) {
            least = std::min<int>(least, image.at(x, side / 2)[0]);
            most = std::max<int>(most, image.at(x, side / 2)[0]);
        }
        return most - least;
    };
    EXPECT_LE(levels(Pattern::plain), 3);  // the highlight of the sun
    EXPECT_GT(levels(Pattern::panel), 20);
}

TEST(Plain, ABallHasNoOctants) {
    const auto jump = [](Pattern pattern) {
        BodyDescription ball = ball_body(Vec3::Zero(), 0.5, {120, 60, 60});
        ball.appearance.pattern = pattern;
        ball.appearance.roughness = 1.0;
        const Image image = drawn(front_view(ball, 80.0, 0.5));
        return std::abs(image.at(side / 2 - 3, side / 2 - 12)[2] - image.at(side / 2 + 3, side / 2 - 12)[2]);
    };
    EXPECT_LE(jump(Pattern::plain), 6);
    EXPECT_GT(jump(Pattern::panel), 10);
}

TEST(Texture, SeenStraightHasTheBrightnessOfPlainBoxes) {
    constexpr int cells = 8, per_cell = 10, first = (side - cells * per_cell) / 2;
    const Image plain[] = {drawn(front_view(cube(red), 80.0, 0.5)), drawn(front_view(cube(blue), 80.0, 0.5))};
    const Image nearest =
        drawn(front_view(textured(cube(red), checker(cells), 0.0, TextureFilter::nearest), 80.0, 0.5));
    const auto albedo = albedo_of(front_view(textured(cube(red), checker(cells)), 80.0, 0.5));
    for (int y = first + 4; y < first + cells * per_cell - 4; ++y)
        for (int x = first + 4; x < first + cells * per_cell - 4; ++x) {
            const int column = (x - first) % per_cell, row = (y - first) % per_cell;
            if (column == 0 || row == 0 || column == per_cell - 1 || row == per_cell - 1) continue;
            const int which = ((x - first) / per_cell + (y - first) / per_cell) % 2;
            EXPECT_LE(difference(nearest.at(x, y), plain[which].at(x, y)), 1) << x << " " << y;
            EXPECT_LE(difference(&albedo[3 * std::size_t(y * side + x)], which == 0 ? red : blue), 1) << x << " " << y;
        }
}

TEST(Texture, FromAfarHasItsMeanInLinearLight) {
    const Image plain = drawn(front_view(cube(mean_of(red, blue)), 80.0, 0.5));
    const Image box = drawn(front_view(textured(cube(red), checker(2), 1.0 / 240.0), 80.0, 0.5));
    visit_middle([&](int x, int y) { EXPECT_LE(difference(box.at(x, y), plain.at(x, y)), 1) << x << " " << y; });

    BodyDescription wall = ground_plane(mean_of(red, blue), Pattern::panel);
    wall.shape = PlaneShape{Vec3::UnitZ(), 0.0};
    const Image plain_wall = drawn(front_view(wall, 80.0, 0.0));
    BodyDescription tiled = textured(wall, checker(2), 1.0 / 240.0);
    const Image tiled_wall = drawn(front_view(tiled, 80.0, 0.0));
    visit_middle([&](int x, int y) {
        EXPECT_LE(difference(tiled_wall.at(x, y), plain_wall.at(x, y)), 2) << x << " " << y;  // both are dithered
    });
}

/// Four quarters of different colors: where the image is upright, its first row is up.
TEST(Texture, IsUprightOnAllShapes) {
    constexpr Color quarters[] = {{250, 20, 20}, {20, 250, 20}, {20, 20, 250}, {250, 250, 20}};
    const auto four = texture_of(16, 16, [&](int x, int y) { return quarters[(x < 8 ? 0 : 1) + (y < 8 ? 0 : 2)]; });
    BodyDescription wall = ground_plane(red, Pattern::panel);
    wall.shape = PlaneShape{Vec3::UnitZ(), 0.0};
    struct Case {
        const char* name;
        BodyDescription body;
        double front, turned;  // degrees about y
    };
    const std::vector<Case> cases = {{"front", cube(red), 0.5, 0.0},
                                     {"right", cube(red), 0.5, -90.0},
                                     {"back", cube(red), 0.5, 180.0},
                                     {"left", cube(red), 0.5, 90.0},
                                     {"ball", ball_body(Vec3::Zero(), 0.5, red), 0.5, 0.0},
                                     {"wall", wall, 0.0, 0.0}};
    for (const Case& one : cases) {
        SCOPED_TRACE(one.name);
        const bool is_wall = one.front == 0.0;
        SceneDescription scene = front_view(textured(one.body, four, is_wall ? 1.0 : 0.0), 80.0, one.front);
        scene.bodies[0].rotation = Quat(Eigen::AngleAxisd(one.turned * pi / 180.0, Vec3::UnitY()));
        // A wall has the corner of an image in its origin.
        if (is_wall) scene.bodies[0].position = Vec3(-0.5, 0.5, 0.0);
        const Image frame = drawn(scene);
        const auto albedo = albedo_of(scene);
        for (int quarter = 0; quarter < 4; ++quarter) {
            const int x = side / 2 + (quarter % 2 == 0 ? -12 : 12), y = side / 2 + (quarter / 2 == 0 ? -12 : 12);
            EXPECT_LE(difference(&albedo[3 * std::size_t(y * side + x)], quarters[quarter]), 1) << quarter;
            const std::uint8_t* pixel = frame.at(x, y);
            for (int c = 0; c < 3; ++c) {
                const Color& color = quarters[quarter];
                const bool bright = (c == 0 ? color.r : c == 1 ? color.g : color.b) > 128;
                EXPECT_EQ(pixel[c] > 128, bright) << quarter << " " << c;
            }
        }
    }
}

TEST(Texture, OfOneColorLooksLikeThatColor) {
    const auto gray = texture_of(4, 4, [](int, int) { return Color{188, 188, 188}; });
    for (BodyDescription body : {cube({188, 188, 188}), ball_body(Vec3::Zero(), 0.5, {188, 188, 188})}) {
        body.appearance.pattern = Pattern::plain;
        const Image plain = drawn(front_view(body, 80.0, 0.5));
        const Image image = drawn(front_view(textured(body, gray), 80.0, 0.5));
        visit_middle([&](int x, int y) { EXPECT_LE(difference(image.at(x, y), plain.at(x, y)), 1); });
    }
}

TEST(Patterns, HaveTwoColorsNearByAndTheirMeanFromAfar) {
    const auto pattern_of = [](Pattern pattern, double scale) {
        BodyDescription body = cube({230, 200, 150}, pattern);
        body.appearance.pattern_color = Color{60, 40, 30};
        body.appearance.pattern_scale = scale;
        return body;
    };
    for (const Pattern pattern : {Pattern::grid, Pattern::checker, Pattern::stripes, Pattern::dots, Pattern::noise,
                                  Pattern::wood, Pattern::marble}) {
        SCOPED_TRACE(int(pattern));
        const Image near_by = drawn(front_view(pattern_of(pattern, 0.25), 80.0, 0.5));
        const Image afar = drawn(front_view(pattern_of(pattern, 0.001), 80.0, 0.5));
        const Image mean = drawn(front_view(cube(mean_color(pattern_of(pattern, 0.001).appearance)), 80.0, 0.5));
        int least = 255, most = 0, worst = 0;
        visit_middle([&](int x, int y) {
            least = std::min<int>(least, near_by.at(x, y)[1]);
            most = std::max<int>(most, near_by.at(x, y)[1]);
            worst = std::max(worst, difference(afar.at(x, y), mean.at(x, y)));
        });
        EXPECT_GT(most - least, 40);
        EXPECT_LE(worst, 12);
    }
}

TEST(Patterns, OfPlanesKeepTheirPlaceWhenTheEyeMoves) {
    for (const Pattern pattern : {Pattern::stripes, Pattern::wood, Pattern::marble}) {
        BodyDescription ground = ground_plane({200, 190, 180}, pattern);
        ground.appearance.pattern_scale = 0.3;
        SceneDescription scene = empty_scene();
        scene.bodies = {ground};
        scene.camera.eye = Vec3(-0.3, 6.0, -0.19);
        scene.camera.target = Vec3(-0.3, 0.0, -0.2);
        const Image before = drawn(scene);
        SceneDescription aside = scene;
        const Vec3 step(0.7, 0.0, 0.4);
        aside.camera.eye += step;
        aside.camera.target += step;
        const Image after = drawn(aside);
        for (const Vec3& point : {Vec3(0.31, 0.0, 0.27), Vec3(0.9, 0.0, 0.6), Vec3(0.2, 0.0, -0.4)})
            EXPECT_NEAR(brightness_at(before, scene, point), brightness_at(after, aside, point), 14.0);
    }
}

TEST(Looks, PartialRedrawsAreWholeOnes) {
    SceneDescription scene = empty_scene();
    scene.bodies = {textured(ground_plane(), checker(8), 0.7), textured(cube(red), checker(8)),
                    cube({200, 170, 120}, Pattern::wood), ball_body(Vec3(-1.5, 0.5, 0.0), 0.5, {230, 230, 225})};
    scene.bodies[1].position = Vec3(0.0, 0.5, 0.0);
    scene.bodies[2].position = Vec3(1.4, 0.5, 0.3);
    scene.bodies[3].appearance.pattern = Pattern::marble;
    Renderer renderer(scene);
    Snapshot snapshot = first_snapshot(scene);
    renderer.render(snapshot);
    snapshot.bodies[1].origin.y() += 0.2;
    snapshot.bodies[3].orientation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
    const Image partial = renderer.render(snapshot);
    EXPECT_EQ(partial, drawn(scene, snapshot));
}

}  // namespace
}  // namespace tumble::looks_test
