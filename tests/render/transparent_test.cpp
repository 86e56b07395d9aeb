// Images with alpha: coverage, color, and partial redraw.
#include "drawing.h"
#include "example_scenes.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tumble::transparent_test {
namespace {

enum class Edges { analytic, multisampled, with_cords, none };
constexpr Edges all_edges[] = {Edges::analytic, Edges::multisampled, Edges::with_cords, Edges::none};

/// Bodies of all kinds, one thinner than a pixel, on a ground and before a wall.
SceneDescription still_life(Edges edges) {
    SceneDescription scene = empty_scene();
    scene.output.samples = edges == Edges::none ? 1 : 4;
    scene.camera.eye = Vec3(0.5, 2.0, 8.0);
    BodyDescription wall = ground_plane({190, 150, 140}, Pattern::plain);
    wall.shape = PlaneShape{Vec3(0.0, 0.0, 1.0), -2.5};
    const Quat turn(Eigen::AngleAxisd(0.4, Vec3(1.0, 2.0, 0.5).normalized()));
    scene.bodies = {ground_plane(),
                    wall,
                    box_body(Vec3(-1.5, 0.5, 0.0), Vec3(1.0, 1.0, 1.0), {200, 60, 40}),
                    box_body(Vec3(-1.2, 1.6, 0.2), Vec3(0.9, 0.9, 0.9), {240, 240, 230}, turn),
                    ball_body(Vec3(0.6, 0.7, 0.0), 0.7, {40, 90, 200}),
                    mesh_body(Vec3(2.2, 0.9, 0.0), torus_asset(0.6, 0.2), {230, 170, 30}, turn),
                    box_body(Vec3(0.0, 2.2, 0.0), Vec3(4.0, 0.02, 0.02), {20, 20, 20})};
    scene.bodies[4].appearance.metallic = 1.0;
    if (edges == Edges::with_cords)
        scene.cords.push_back({4, Vec3(0.0, 0.7, 0.0), Vec3(0.6, 3.2, 0.0), 0.02, {60, 60, 60}});
    return scene;
}

RenderSwitches with_alpha(Edges edges) {
    RenderSwitches switches;
    switches.transparent = true;
    switches.multisample = edges == Edges::multisampled;
    return switches;
}

int coverage(const Image& image, int x, int y) { return image.at(x, y)[3]; }

double covered_pixels(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) sum += image.pixels[i] / 255.0;
    return sum;
}

Image over(const Image& image, const std::array<std::uint8_t, 3>& background) {
    Image result(image.width, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const double share = image.pixels[i + 3] / 255.0;
        for (std::size_t c = 0; c < 3; ++c)
            result.pixels[i + c] =
                std::uint8_t(std::lround(share * image.pixels[i + c] + (1.0 - share) * background[c]));
        result.pixels[i + 3] = 255;
    }
    return result;
}

TEST(Transparent, BodiesKeepTheirPixels) {
    for (const Edges edges : all_edges) {
        const SceneDescription scene = still_life(edges);
        RenderSwitches opaque = with_alpha(edges);
        opaque.transparent = false;
        const Image image = drawn(scene, with_alpha(edges)), usual = drawn(scene, opaque);
        int inside = 0, between = 0, outside = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
            const std::uint8_t* const pixel = &image.pixels[i];
            ASSERT_EQ(usual.pixels[i + 3], 255);
            if (pixel[3] == 255) {
                ++inside;
                ASSERT_TRUE(std::equal(pixel, pixel + 3, &usual.pixels[i]))
                    << "light, shadows, occlusion by the planes";
            } else if (pixel[3] == 0) {
                ++outside;
                ASSERT_EQ(pixel[0] + pixel[1] + pixel[2], 0);
            } else {
                ++between;
            }
        }
        EXPECT_GT(inside, 2000);
        EXPECT_GT(outside, 20000);
        EXPECT_EQ(between > 200, edges != Edges::none) << between;
        EXPECT_EQ(coverage(image, 0, 0), 0) << "sky";
        EXPECT_EQ(coverage(image, 0, image.height - 1), 0) << "ground";
        const Pixel box = pixel_of(scene, scene.bodies[2].position);
        EXPECT_EQ(coverage(image, box.x, box.y), 255);
    }
}

TEST(Transparent, OverAColorItIsThePictureBeforeThatColor) {
    for (const Edges edges : all_edges)
        for (const std::array<std::uint8_t, 3> color :
             {std::array<std::uint8_t, 3>{255, 255, 255}, {0, 0, 0}, {255, 0, 90}}) {
            const SceneDescription scene = still_life(edges);
            RenderSwitches plain;
            plain.multisample = edges == Edges::multisampled;
            plain.plain_background = color;
            const Image composed = over(drawn(scene, with_alpha(edges)), color), wanted = drawn(scene, plain);
            int most = 0, beyond = 0;
            for (std::size_t i = 0; i < wanted.pixels.size(); ++i) {
                const int difference = std::abs(composed.pixels[i] - wanted.pixels[i]);
                most = std::max(most, difference);
                beyond += difference > 1 ? 1 : 0;
            }
            // Where several edges cross a pixel, each is rounded, in the picture before the color too.
            EXPECT_LE(most, 2) << int(edges) << ", " << int(color[1]);
            EXPECT_LE(beyond, 8) << int(edges) << ", " << int(color[1]);
        }
}

TEST(Transparent, TheCoverageOfABallIsItsArea) {
    SceneDescription scene = empty_scene();
    scene.output.samples = 4;
    scene.camera.eye = Vec3(0.0, 0.0, 10.0);
    scene.camera.target = Vec3::Zero();
    for (const double radius : {0.3, 1.0, 2.0}) {
        scene.bodies = {ground_plane(), ball_body(Vec3(0.0, 0.0, 0.0), radius, {240, 240, 240})};
        scene.bodies[0].position.y() = -2.0;
        const double pixel = Camera(scene.camera, scene.output.width, scene.output.height).pixel_size();
        const double tangent = radius / std::sqrt(100.0 - radius * radius) / pixel;  // radius on the screen, pixels
        const double area = M_PI * tangent * tangent, outline = 2.0 * M_PI * tangent;
        const double polygon = 0.03;  // deviation of the drawn outline, pixels
        EXPECT_NEAR(covered_pixels(drawn(scene, with_alpha(Edges::analytic))), area, polygon * outline) << radius;
    }
}

TEST(Transparent, ChangedRegionsGiveTheWhole) {
    Random random(4);
    for (const Edges edges : all_edges) {
        const SceneDescription scene = still_life(edges);
        RenderSwitches anew = with_alpha(edges);
        anew.full_redraw = true;
        Renderer partial(scene, with_alpha(edges)), whole(scene, anew);
        Snapshot snapshot = first_snapshot(scene);
        Image kept;
        for (int frame = 0; frame < 12; ++frame) {
            if (frame > 0) {
                BodyState& body = snapshot.bodies[2 + std::size_t(frame) % 5];
                body.origin += random.vector(0.4);
                body.orientation = random.turn();
            }
            const Image& image = partial.render(snapshot);
            ASSERT_EQ(image, whole.render(snapshot)) << int(edges) << ", frame " << frame;
            if (frame == 0) kept = image;
            for (const Rectangle& r : partial.changed())
                for (int y = r.y; y < r.y + r.height; ++y) std::copy_n(image.at(r.x, y), 4 * r.width, kept.at(r.x, y));
            ASSERT_EQ(image, kept) << "changed outside of changed()";
        }
        // The ground receives shadows and is not drawn: no tile changes where they fall.
        snapshot.bodies[4].origin.y() += 30.0;
        partial.render(snapshot);
        snapshot.bodies[4].origin.y() += 1.0;
        partial.render(snapshot);
        EXPECT_EQ(partial.changed().empty(), edges != Edges::with_cords) << int(edges);
    }
}

}  // namespace
}  // namespace tumble::transparent_test
