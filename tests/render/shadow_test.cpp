// Edges of shadows in images that are coarser than the shadow map, compared with exact areas; and light where nothing
// is in shadow: before lit walls, beside bodies far away, and above bodies that are hidden by a plane.
#include "drawing.h"
#include "example_scenes.h"

#include "core/color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tumble::shadow_test {
namespace {

SceneDescription shadow_scene(int width, int height, bool on_box) {
    SceneDescription scene = empty_scene();
    scene.output.width = width;
    scene.output.height = height;
    scene.camera.eye = Vec3(1.0, 4.0, 9.0);
    scene.camera.target = Vec3(-0.8, 0.4, 0.0);
    scene.light.direction = Vec3(-0.5, -1.0, 0.1);
    scene.bodies = {ground_plane({190, 190, 190}, Pattern::plain),
                    box_body(Vec3(0.0, 2.0, 0.0), Vec3(1.6, 1.0, 1.2), {200, 133, 60})};
    scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(0.3, Vec3(0.2, 1.0, 0.1).normalized()));
    if (on_box) {
        scene.bodies[0] = box_body(Vec3(0.0, -0.5, 0.0), Vec3(60.0, 1.0, 60.0), {190, 190, 190});
        scene.bodies[0].type = BodyType::fixed;
    }
    return scene;
}

/// True if the ray meets the box (the slabs of Kay and Kajiya 1986).
bool hits(const BodyDescription& box, const Vec3& from, const Vec3& direction) {
    const Vec3 at = box.rotation.conjugate() * (from - box.position), way = box.rotation.conjugate() * direction;
    const Vec3 half = 0.5 * std::get<BoxShape>(box.shape).size;
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const double a = (-half[k] - at[k]) / way[k], b = (half[k] - at[k]) / way[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
}

double linear(const Image& image, int x, int y) { return srgb_to_linear(image.at(x, y)[1] / 255.0); }

struct Edges {
    int pixels = 0;
    double rms = 0.0;  // error of the share in shadow
};

/// Pixels of the ground that are partly in shadow: their exact share, and the share in the image.
Edges shadow_edges(int width, int height, bool on_box) {
    SceneDescription scene = shadow_scene(width, height, on_box);
    const Image image = drawn(scene);
    scene.light.shadows = false;
    const Image open = drawn(scene);
    const Camera view(scene.camera, width, height);
    const Pixel inside = pixel_of(scene, Vec3(-1.0, 0.0, 0.2));
    const double dark = linear(image, inside.x, inside.y) / linear(open, inside.x, inside.y);
    EXPECT_LT(dark, 0.6);
    Edges edges;
    double squares = 0.0;
    constexpr int rays = 12;  // per side of the pixel
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            int count = 0, of_body = 0;
            for (int i = 0; i < rays * rays; ++i) {
                const Vec3 ray = view.ray(x + (i % rays + 0.5) / rays, y + (i / rays + 0.5) / rays);
                if (ray.y() > -1e-3 || hits(scene.bodies[1], view.eye(), ray))
                    ++of_body;
                else if (hits(scene.bodies[1], view.eye() - ray * (view.eye().y() / ray.y()), -scene.light.direction))
                    ++count;
            }
            if (of_body > 0 || count == 0 || count == rays * rays) continue;
            const double said = (1.0 - linear(image, x, y) / linear(open, x, y)) / (1.0 - dark);
            const double error = said - double(count) / (rays * rays);
            squares += error * error;
            ++edges.pixels;
        }
    edges.rms = std::sqrt(squares / edges.pixels);
    return edges;
}

// Unfiltered shadows would have an error of 0.29, the map's own filter of less than a pixel 0.22 to 0.25.
TEST(Shadows, EdgesInSmallImagesHaveExactCoverage) {
    for (const bool on_box : {false, true})
        for (const int height : {60, 90, 180}) {
            const Edges edges = shadow_edges(height * 16 / 9, height, on_box);
            EXPECT_GT(edges.pixels, height / 2);
            EXPECT_LT(edges.rms, 0.16) << height << " rows" << (on_box ? ", on a box" : "");
        }
}

/// A white ball and a white box on a plane, whose lit side meets the ground.
SceneDescription ball_and_box() {
    SceneDescription scene = empty_scene();
    scene.output.width = 640;
    scene.output.height = 360;
    scene.camera.eye = Vec3(2.6, 2.7, 5.6);
    scene.camera.target = Vec3(0.9, 0.8, 0.0);
    scene.bodies = {ground_plane({190, 190, 190}, Pattern::plain), ball_body(Vec3(0.0, 1.0, 0.0), 1.0, {255, 255, 255}),
                    box_body(Vec3(2.0, 0.5, 0.0), Vec3::Ones(), {255, 255, 255})};
    return scene;
}

// The kernel's taps beyond the wall are nearer to the sun than the ground is: without the lift a tenth is in shadow.
TEST(Shadows, TheFootOfALitWallIsLit) {
    SceneDescription scene = ball_and_box();
    for (const double height : {0.4, 1.0, 2.0})  // of the sun
        for (const int side : {0, 2}) {
            scene.light.direction = side == 0 ? Vec3(-1.0, -height, -0.3) : Vec3(-0.3, -height, -1.0);
            scene.light.shadows = true;
            const Image image = drawn(scene);
            scene.light.shadows = false;
            const Image open = drawn(scene);
            for (int k = -4; k <= 4; ++k) {
                const double along = 0.1 * k, beyond = 0.504;  // m, from the middle of the wall
                const Pixel at =
                    pixel_of(scene, side == 0 ? Vec3(2.0 + beyond, 0.0, along) : Vec3(2.0 + along, 0.0, beyond));
                for (int x = at.x; x <= at.x + 2; ++x)
                    EXPECT_GT(linear(image, x, at.y + 1), 0.97 * linear(open, x, at.y + 1))
                        << height << ' ' << side << ' ' << k;
            }
        }
}

// Casters that no map reaches, and such that are far above or below, take no step of the others' depths or texels.
TEST(Shadows, BodiesFarAwayChangeNone) {
    SceneDescription scene = ball_and_box();
    const auto with_box_at = [&](const Vec3& position) {
        SceneDescription more = scene;
        more.bodies.push_back(box_body(position, Vec3::Ones(), {255, 255, 255}));
        return drawn(more);
    };
    const Vec3 back = (scene.camera.eye - scene.camera.target).normalized();
    const Image out_of_view = with_box_at(1e5 * back);
    const Vec3 to_sun = -scene.light.direction.normalized();
    std::vector<Vec3> places = {1e6 * to_sun + 40.0 * back, -1e6 * to_sun, Vec3(0.0, -2e6, 0.0)};
    for (const double distance : {1e5, 1e6})
        for (const double aside : {-0.4, 0.0, 0.4})
            places.push_back(distance * Vec3(-back.x() + aside * back.z(), 5e-6, -back.z() - aside * back.x()));
    for (const Vec3& place : places) {
        const Image image = with_box_at(place);
        int different = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                different += !std::equal(image.at(x, y), image.at(x, y) + 3, out_of_view.at(x, y));
        EXPECT_LE(different, 4) << place.transpose();  // the box itself
    }
}

// The plane hides it: it is not drawn in stripes with the plane, and does not darken bodies above.
TEST(Shadows, ABodyBelowThePlaneDoesNotShow) {
    SceneDescription scene = ball_and_box();
    const auto with_box_at = [&](const Vec3& position) {
        SceneDescription more = scene;
        more.bodies.push_back(box_body(position, Vec3::Ones(), {255, 0, 0}));
        return drawn(more);
    };
    const Image deep = with_box_at({0.2, -9.0, 0.4});
    for (const double top : {0.0, -1e-4, -0.05}) {
        const Image image = with_box_at({0.2, top - 0.5, 0.4});
        int different = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (int c = 0; c < 3; ++c) different += std::abs(image.at(x, y)[c] - deep.at(x, y)[c]) > 2;
        EXPECT_EQ(different, 0) << top;
    }
}

}  // namespace
}  // namespace tumble::shadow_test
