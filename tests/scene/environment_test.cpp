// [environment]: its keys and their errors, HDR files, and the irradiance of images whose irradiance is known.
#include "scene/environment/exr_image.h"
#include "scene/environment/hdr_image.h"
#include "scene/environment/irradiance.h"
#include "scene/environment/mirror_map.h"
#include "scene/environment/presets.h"
#include "scene/load.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/error_text.h"
#include "support/folder.h"

#include "core/deterministic_math.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace tumble::environment_test {
namespace {

constexpr const char* head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
constexpr const char* ball =
    "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 0.5 }\nposition = [0, 1, 0]\n";

std::string bytes_of(std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) bytes.push_back(char(value));
    return bytes;
}

EnvironmentDescription environment_of(int width, int height, const auto& light_toward) {
    auto image = std::make_shared<EnvironmentImage>(EnvironmentImage{width, height, {}});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto light = float(light_toward(direction_of_texel(*image, x, y)));
            image->texels.push_back({light, light, light});
        }
    EnvironmentDescription environment;
    environment.image = std::move(image);
    return environment;
}

/// Irradiance, of red.
double received(const Irradiance& c, const Vec3& n) {
    const double shapes[] = {1.0,           n.x(),         n.y(),
                             n.z(),         n.x() * n.y(), n.y() * n.z(),
                             n.x() * n.z(), n.z() * n.z(), n.x() * n.x() - n.y() * n.y()};
    double sum = 0.0;
    for (std::size_t i = 0; i < 9; ++i) sum += double(c[i][0]) * shapes[i];
    return pi * sum;
}

std::string fault_of(const std::string& lines) {
    try {
        parse_scene(std::string(ball) + "[environment]\n" + lines, "scene.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

EnvironmentDescription parsed(const std::string& lines) {
    return *parse_scene(std::string(ball) + "[environment]\n" + lines, "scene.toml").environment;
}

TEST(Irradiance, OfASkyThatGrowsWithTheHeight) {
    const Irradiance light =
        irradiance_of(environment_of(256, 128, [](const Vec3& d) { return std::max(0.0, d.y()); }));
    const double above = 2.0 * pi / 3.0;
    EXPECT_NEAR(received(light, Vec3::UnitY()), above, 0.01 * above);
    EXPECT_NEAR(received(light, -Vec3::UnitY()), 0.0, 0.01 * above);
}

TEST(Irradiance, OfHalfAWhiteSky) {
    const Irradiance light =
        irradiance_of(environment_of(256, 128, [](const Vec3& d) { return d.y() > 0.0 ? 1.0 : 0.0; }));
    for (const Vec3& level : {Vec3(Vec3::UnitX()), Vec3(-Vec3::UnitZ()), Vec3(0.6, 0.0, 0.8)})
        EXPECT_NEAR(received(light, level), pi / 2.0, 1e-3);
    EXPECT_NEAR(received(light, Vec3::UnitY()), pi, 0.01 * pi);
}

TEST(Irradiance, TurnsWithTheImageCounterClockwiseFromAbove) {
    auto environment = environment_of(256, 128, [](const Vec3& d) { return std::max(0.0, d.x()); });
    const double ahead = received(irradiance_of(environment), Vec3::UnitX());
    EXPECT_NEAR(ahead, 2.0 * pi / 3.0, 0.03);
    environment.rotation = 90.0;
    environment.intensity = 0.5;
    EXPECT_NEAR(received(irradiance_of(environment), -Vec3::UnitZ()), 0.5 * ahead, 1e-4);
    EXPECT_NEAR(received(irradiance_of(environment), Vec3::UnitZ()), 0.0, 0.02);
}

/// The texel of a tile that shows a direction of the upper half: x to the right, z downward.
const std::array<float, 4>& mirrored_at(const MirrorMap& map, int tile, double x, double z) {
    const double sum = std::abs(x) + std::abs(z) + std::sqrt(std::max(0.0, 1.0 - x * x - z * z));
    const int inner = (tile == 0 ? MirrorMap::sharp_side : MirrorMap::rough_side) - 2;
    const int left = tile == 0 ? 0 : MirrorMap::rough_side * ((tile - 1) % 2);
    const int top = tile == 0 ? 0 : MirrorMap::sharp_side + MirrorMap::rough_side * ((tile - 1) / 2);
    const auto place = [&](double s) { return std::clamp(int((0.5 + 0.5 * s / sum) * inner), 0, inner - 1) + 1; };
    return map.texels[std::size_t(top + place(z)) * std::size_t(MirrorMap::width) + std::size_t(left + place(x))];
}

TEST(MirrorMap, OfEvenLightIsEven) {
    const MirrorMap map = make_mirror_map(environment_of(16, 8, [](const Vec3&) { return 0.75; }));
    for (const auto& texel : map.texels) EXPECT_NEAR(texel[0], 0.75f, 1e-4f);
}

TEST(MirrorMap, ALampBecomesWiderWithTheRoughness) {
    const Vec3 lamp = Vec3(0.5, 0.7, -0.2).normalized();
    auto environment = environment_of(512, 256, [&](const Vec3& d) { return d.dot(lamp) > 0.98 ? 10.0 : 0.0; });
    const MirrorMap map = make_mirror_map(environment);
    EXPECT_NEAR(mirrored_at(map, 0, lamp.x(), lamp.z())[0], 10.0f, 0.1f);
    EXPECT_EQ(mirrored_at(map, 0, -lamp.x(), -lamp.z())[0], 0.0f);
    float before = 10.1f;
    for (int tile = 1; tile <= MirrorMap::rough_count; ++tile) {
        const float middle = mirrored_at(map, tile, lamp.x(), lamp.z())[0];
        EXPECT_LT(middle, before) << tile;
        before = middle;
    }
    EXPECT_GT(before, 0.05f);
    environment.rotation = 90.0;  // +x becomes -z
    EXPECT_NEAR(mirrored_at(make_mirror_map(environment), 0, lamp.z(), -lamp.x())[0], 10.0f, 0.1f);
}

TEST(MirrorMap, IsTheSameAgain) {
    const EnvironmentDescription environment = parsed("preset = \"dusk\"\n");
    EXPECT_EQ(make_mirror_map(environment).texels, make_mirror_map(environment).texels);
}

TEST(Presets, HaveLightThatIsBrighterAbove) {
    for (const std::string_view name : environment_presets) {
        EnvironmentDescription environment;
        environment.image = environment_preset(name).image;
        for (const auto& texel : environment.image->texels)
            for (const float channel : texel) ASSERT_TRUE(channel > 0.0f && channel < 20.0f) << name;
        const Irradiance light = irradiance_of(environment);
        EXPECT_GT(received(light, Vec3::UnitY()), received(light, -Vec3::UnitY())) << name;
    }
}

TEST(HdrImage, ReadsTexelsRunsAndChannels) {
    const EnvironmentImage plain = read_hdr_image(head + ("-Y 1 +X 2\n" + bytes_of({128, 64, 0, 129, 9, 9, 9, 0})));
    EXPECT_EQ(plain.width, 2);
    EXPECT_EQ(plain.height, 1);
    EXPECT_FLOAT_EQ(plain.at(0, 0)[0], 128.5f / 128.0f);
    EXPECT_FLOAT_EQ(plain.at(0, 0)[1], 64.5f / 128.0f);
    EXPECT_EQ(plain.at(1, 0)[0], 0.0f);  // exponent 0: black

    const EnvironmentImage run = read_hdr_image(head + ("-Y 1 +X 4\n" + bytes_of({8, 16, 32, 128, 1, 1, 1, 3})));
    for (int x = 0; x < 4; ++x) EXPECT_EQ(run.at(x, 0), run.at(0, 0));

    std::string row = bytes_of({2, 2, 0, 8});
    for (const int value : {100, 50, 25}) row += bytes_of({128 + 8, value});
    row += bytes_of({4, 129, 129, 129, 129, 128 + 4, 130});
    const EnvironmentImage channels = read_hdr_image(head + ("-Y 1 +X 8\n" + row));
    EXPECT_FLOAT_EQ(channels.at(0, 0)[0], 100.5f / 128.0f);
    EXPECT_FLOAT_EQ(channels.at(7, 0)[2], 2.0f * 25.5f / 128.0f);
}

TEST(HdrImage, RefusesBrokenFiles) {
    const auto fault = [](const std::string& bytes) -> std::string {
        try {
            read_hdr_image(bytes);
        } catch (const MeshError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(fault(std::string(head) + "-Y 2 +X 2\n" + bytes_of({1, 2, 3, 4})), "ends too early");
    EXPECT_EQ(fault("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + bytes_of({1, 2, 3, 4})),
              "has colors that are not red, green and blue");
    EXPECT_EQ(fault(std::string(head) + "+X 2 -Y 2\n"), "has rows in another order than \"-Y HEIGHT +X WIDTH\"");
    EXPECT_EQ(fault(std::string(head) + "-Y 0 +X 2\n"), "has no valid size");
    EXPECT_EQ(fault(std::string(head) + "-Y 4 +X 5000\n"), "is too large: 5000 x 4 pixels (at most 4096 a side)");
    EXPECT_EQ(fault(std::string(head) + "-Y 1 +X 2\n" + bytes_of({1, 1, 1, 1, 5, 5, 5, 5})),
              "has a row of another length");
    EXPECT_EQ(fault("#?RADIANCE"), "has no image after its header");
}

TEST(Environment, ReadsItsKeys) {
    EXPECT_FALSE(parse_scene(ball, "scene.toml").environment);
    const EnvironmentDescription preset = parsed("preset = \"studio\"\nrotation = 30\nintensity = 2\nblur = 0.25\n");
    EXPECT_EQ(preset.background, BackgroundKind::image);
    EXPECT_EQ(preset.rotation, 30.0);
    EXPECT_EQ(preset.intensity, 2.0);
    EXPECT_EQ(preset.blur, 0.25);
    EXPECT_TRUE(preset.image);
    const EnvironmentDescription plain = parsed("background = \"#202428\"\n");
    EXPECT_EQ(plain.background, BackgroundKind::colors);
    EXPECT_EQ(plain.low, (Color{0x20, 0x24, 0x28}));
    EXPECT_EQ(plain.high, plain.low);
    const EnvironmentDescription gradient = parsed("background = [\"#ffffff\", \"#000000\"]\npreset = \"dusk\"\n");
    EXPECT_EQ(gradient.high, (Color{0, 0, 0}));
    EXPECT_TRUE(gradient.image);
    EXPECT_EQ(parsed("preset = \"dusk\"\nbackground = \"sky\"\n").background, BackgroundKind::sky);
}

TEST(Environment, ReadsAnHdrFileBesideTheScene) {
    const TestFolder folder;
    std::ofstream(folder.path() / "sky.hdr", std::ios::binary) << head << "-Y 1 +X 2\n"
                                                               << bytes_of({128, 64, 0, 129, 9, 9, 9, 0});
    FileList files;
    const SceneDescription scene = parse_scene(std::string(ball) + "[environment]\nimage = \"sky.hdr\"\n",
                                               folder.path() / "scene.toml", {}, &files);
    EXPECT_EQ(scene.environment->image->width, 2);
    EXPECT_EQ(files.back().filename(), "sky.hdr");
}

TEST(Environment, NamesTheFault) {
    const auto has = [](const std::string& fault, const char* text) {
        EXPECT_NE(fault.find(text), std::string::npos) << fault;
    };
    has(fault_of("preset = \"beach\"\n"), "scene.toml:6:");
    has(fault_of("preset = \"beach\"\n"), "\"overcast\"");
    has(fault_of("preset = \"dusk\"\nimage = \"a.hdr\"\n"), "image and preset exclude each other");
    has(fault_of("image = \"missing.hdr\"\n"), "image \"missing.hdr\"");
    has(fault_of("background = \"image\"\n"), "needs a preset or an image");
    has(fault_of("background = \"blue\"\n"), "must be \"sky\", \"image\", a color");
    has(fault_of("background = [\"#000000\"]\n"), "colors");
    has(fault_of("rotation = 90\n"), "has an effect on an image only");
    has(fault_of("blurr = 1\n"), "blur");
}

std::string exr_file(const std::string& name) { return TUMBLE_SOURCE_DIR "/tests/fuzz/corpus/exr/" + name + ".exr"; }

/// Why the program cannot read an image of the corpus, or the image.
std::string exr_fault(const std::string& name, EnvironmentImage* image = nullptr) {
    try {
        const EnvironmentImage read = import_exr_image(read_mesh_bytes(exr_file(name)));
        if (image != nullptr) *image = read;
    } catch (const MeshError& error) {
        return error.what();
    }
    return "none";
}

/// True if the program is built without OpenEXR, which the error must say.
bool without_exr() { return exr_fault("plain").find("libopenexr-dev") != std::string::npos; }

TEST(ExrImage, HasTheLightOfItsFileInAnyCompression) {
    if (without_exr()) GTEST_SKIP();
    for (const char* name : {"plain", "zip", "piz", "invalid_light"}) {
        EnvironmentImage image;
        ASSERT_EQ(exr_fault(name, &image), "none") << name;
        ASSERT_EQ(image.width, 8);
        ASSERT_EQ(image.height, 4);
        const bool invalid = std::string(name) == "invalid_light";  // negative, and no number
        EXPECT_EQ(image.at(6, 3), (std::array{3.0f, 0.75f, 0.125f})) << name;
        EXPECT_EQ(image.at(1, 0), (std::array{invalid ? 0.0f : 0.5f, 0.0f, 6.0f})) << name;
        EXPECT_EQ(image.at(2, 2), (std::array{1.0f, invalid ? 0.0f : 0.5f, 0.125f})) << name;
    }
    EnvironmentImage tiled;
    ASSERT_EQ(exr_fault("tiled", &tiled), "none");
    EXPECT_EQ(tiled.at(7, 3), (std::array{1.0f, 2.0f, 3.0f}));
    EXPECT_EQ(exr_fault("luminance"), "none");
}

TEST(ExrImage, IsRefusedIfItIsCut) {
    if (without_exr()) GTEST_SKIP();
    EXPECT_NE(exr_fault("cut"), "none");
    EXPECT_EQ(fault_of("image = \"" + exr_file("plain") + "\"\n"), "none");
    EXPECT_NE(fault_of("image = \"" + exr_file("cut") + "\"\n").find("scene.toml:6:9"), std::string::npos)
        << fault_of("image = \"" + exr_file("cut") + "\"\n");
}

}  // namespace
}  // namespace tumble::environment_test
