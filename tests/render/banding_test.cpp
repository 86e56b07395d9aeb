// Smooth gradients over the whole image have no visible bands.
#include "drawing.h"
#include "example_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tumble::banding_test {
namespace {

// The means of 8 x 8 pixels down the middle of the image, in levels of green.
std::vector<double> block_means(const Image& image) {
    std::vector<double> means;
    for (int top = 0; top + 8 <= image.height; top += 8) {
        double sum = 0.0;
        for (int y = top; y < top + 8; ++y)
            for (int x = image.width / 2; x < image.width / 2 + 8; ++x) sum += image.at(x, y)[1];
        means.push_back(sum / 64.0);
    }
    return means;
}

// A gradient of some levels over the whole image: rounded to the nearest level, it would have visible bands.
TEST(Banding, SkyAndGroundHaveNoBands) {
    SceneDescription sky = empty_scene(), ground = empty_scene();
    sky.camera.target = Vec3(0.0, 3.0, 0.0);
    ground.bodies = {ground_plane({185, 188, 194}, Pattern::plain)};
    ground.camera.target = Vec3(0.0, -0.2, 0.0);
    for (SceneDescription* scene : {&sky, &ground}) {
        scene->output.width = 640;
        scene->output.height = 360;
        scene->camera.vertical_fov = scene == &sky ? 5.0 : 12.0;
        const std::vector<double> means = block_means(drawn(*scene));
        EXPECT_GT(std::abs(means.back() - means.front()), 1.5) << "there must be steps to see";
        EXPECT_LT(std::abs(means.back() - means.front()), 30.0) << "they must be wide";
        for (std::size_t i = 1; i + 1 < means.size(); ++i)
            EXPECT_NEAR(means[i - 1] - 2.0 * means[i] + means[i + 1], 0.0, 0.3)
                << (scene == &sky ? "sky" : "ground") << ", row " << 8 * i;
    }
}

}  // namespace
}  // namespace tumble::banding_test
