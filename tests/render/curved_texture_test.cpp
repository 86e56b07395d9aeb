// Textures on curved shapes: a label seen straight has its rows at their heights and its columns at their angles.
#include "drawing.h"

#include "core/deterministic_math.h"
#include "output/png_writer.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace tumble::curved_texture_test {
namespace {

constexpr int cells = 16;

/// A checker of red and blue.
SceneDescription label_on(const std::string& shape, const std::filesystem::path& folder) {
    Image image(cells, cells);
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const bool red = (x + y) % 2 == 0;
            const std::uint8_t bytes[] = {std::uint8_t(red ? 210 : 30), 30, std::uint8_t(red ? 30 : 210), 255};
            std::copy_n(bytes, 4, image.at(x, y));
        }
    PngEncoder encoder;
    const auto bytes = encoder.encode(image);
    std::ofstream(folder / "label.png", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return parse_scene(
        "format = 1\n[output]\nsize = [480, 480]\nsamples = 1\n"
        "[camera]\neye = [0, 0, 40]\ntarget = [0, 0, 0]\nvertical_fov = 3\n"
        "[light]\ndirection = [0, 0, -1]\nshadows = false\n"
        "[[body]]\ntexture = \"label.png\"\ntexture_filter = \"nearest\"\nroughness = 1\nshape = " +
            shape,
        folder / "scene.toml");
}

struct Case {
    const char* shape;
    double radius_at[2];  // m, at the lower and the upper end of the part that is looked at
    double half_height;   // m, of the whole
    double seen;          // share of the height
};

class Label : public ::testing::TestWithParam<Case> {};

TEST_P(Label, HasRowsAtTheirHeightsAndColumnsAtTheirAngles) {
    const Case& one = GetParam();
    const TestFolder folder;
    const SceneDescription scene = label_on(one.shape, folder.path());
    const Image frame = drawn(scene);
    const auto decided = [](double u) { return std::abs(u * cells - std::round(u * cells)) > 0.15; };
    int looked_at = 0;
    for (double v = 0.5 - 0.5 * one.seen; v <= 0.5 + 0.5 * one.seen; v += 0.011) {
        const double y = one.half_height * (1.0 - 2.0 * v);
        const double share = 0.5 * (y / one.half_height + 1.0);
        const double radius = one.radius_at[0] + share * (one.radius_at[1] - one.radius_at[0]);
        for (double angle = -50.0; angle <= 50.0; angle += 3.0) {
            const double u = 0.5 + angle / 360.0;
            if (!decided(u) || !decided(v)) continue;
            const SinCos turn = sincos(angle * pi / 180.0);
            const Pixel at = pixel_of(scene, Vec3(radius * turn.sin, y, radius * turn.cos));
            const std::uint8_t* pixel = frame.at(at.x, at.y);
            EXPECT_EQ(pixel[0] > pixel[2], (int(u * cells) + int(v * cells)) % 2 == 0) << u << " " << v;
            ++looked_at;
        }
    }
    EXPECT_GT(looked_at, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Label,
    ::testing::Values(Case{"{ type = \"cylinder\", radius = 0.4, height = 1.4 }", {0.4, 0.4}, 0.7, 0.9},
                      Case{"{ type = \"capsule\", radius = 0.4, height = 0.8 }", {0.4, 0.4}, 0.8, 0.45},
                      Case{"{ type = \"cone\", radius = 0.6, height = 1.6 }", {0.6, 0.0}, 0.8, 0.6},
                      Case{"{ type = \"cone\", radius = 0.6, top_radius = 0.3, height = 1.6 }", {0.6, 0.3}, 0.8, 0.9}));

}  // namespace
}  // namespace tumble::curved_texture_test
