// Grids and scatters: places of the copies, and their dependence on the seed only.
#include "core/error.h"
#include "core/random.h"
#include "scene/load.h"
#include "sim/geometry/shapes/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tumble::arrays_test {
namespace {

std::vector<BodyDescription> bodies(const std::string& lines, int seed = 1,
                                    const std::string& shape = "{ type = \"box\", size = [1, 2, 3] }") {
    return parse_scene("format = 1\n[simulation]\nseed = " + std::to_string(seed) + "\n[[body]]\nshape = " + shape +
                           "\n" + lines,
                       "scene.toml")
        .bodies;
}

std::vector<double> numbers(const std::vector<BodyDescription>& list) {
    std::vector<double> result;
    for (const BodyDescription& b : list) {
        for (int i = 0; i < 3; ++i) result.push_back(b.position[i]);
        for (int i = 0; i < 4; ++i) result.push_back(b.rotation.coeffs()[i]);
        if (const auto* box = std::get_if<BoxShape>(&b.shape)) result.push_back(box->size.x());
    }
    return result;
}

TEST(Grid, IsCenteredAndGrowsUpward) {
    const auto list =
        bodies("position = [10, 20, 30]\ngrid = { count = [3, 2, 2], spacing = [2, 5, 4] }\nname = \"crate\"");
    ASSERT_EQ(list.size(), 12u);
    EXPECT_EQ(list[0].position, Vec3(8, 20, 28));
    EXPECT_EQ(list[1].position, Vec3(10, 20, 28));  // x runs fastest
    EXPECT_EQ(list[3].position, Vec3(8, 20, 32));   // then z
    EXPECT_EQ(list[6].position, Vec3(8, 25, 28));   // layer by layer
    EXPECT_EQ(list[11].position, Vec3(12, 25, 32));
    EXPECT_EQ(list[0].name, "crate.0");
    EXPECT_EQ(list[11].name, "crate.11");
    for (const BodyDescription& b : list) EXPECT_EQ(b.rotation.coeffs(), Quat::Identity().coeffs());
}

TEST(Grid, CopiesWithoutANameHaveTheirIndex) {
    const auto scene = parse_scene(
        "format = 1\n[[body]]\ntype = \"fixed\"\nshape = { type = \"plane\" }\n[[body]]\n"
        "shape = { type = \"sphere\", radius = 1 }\ngrid = { count = [2, 1, 1], spacing = 3 }",
        "a.toml");
    ASSERT_EQ(scene.bodies.size(), 3u);
    EXPECT_EQ(scene.bodies[1].name, "1");
    EXPECT_EQ(scene.bodies[2].name, "2");
}

TEST(Grid, JitterAndTiltStayWithinTheirBounds) {
    const auto plain = bodies("grid = { count = [10, 10, 10], spacing = 4 }");
    const auto list = bodies("grid = { count = [10, 10, 10], spacing = 4, jitter = [0.1, 0, 0.3], tilt = 15 }");
    const Vec3 jitter(0.1, 0.0, 0.3);
    Vec3 most = Vec3::Zero(), sum = Vec3::Zero();
    double most_tilt = 0.0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Vec3 moved = list[i].position - plain[i].position;
        most = most.cwiseMax(moved.cwiseAbs());
        sum += moved;
        most_tilt = std::max(most_tilt, list[i].rotation.angularDistance(Quat::Identity()) * 180.0 / M_PI);
        EXPECT_NEAR(list[i].rotation.norm(), 1.0, 1e-15);
    }
    EXPECT_TRUE((most.array() <= jitter.array() + 1e-12).all());
    EXPECT_TRUE((most.array() >= 0.95 * jitter.array()).all());  // and the bounds are reached
    EXPECT_LT((sum / 1000.0).norm(), 0.02);
    EXPECT_LE(most_tilt, 15.0 + 1e-9);
    EXPECT_GT(most_tilt, 14.0);
}

TEST(Grid, TheSameSeedGivesTheSameBytesAndAnotherGivesOthers) {
    const std::string lines = "grid = { count = [5, 5, 5], spacing = 4, jitter = 0.1, tilt = 5 }\nscale = [0.5, 1.5]";
    EXPECT_EQ(numbers(bodies(lines, 7)), numbers(bodies(lines, 7)));
    EXPECT_NE(numbers(bodies(lines, 7)), numbers(bodies(lines, 8)));
}

TEST(Grid, APaletteChangesOnlyColors) {
    const std::string lines = "grid = { count = [5, 5, 5], spacing = 4, jitter = 0.1, tilt = 5 }\n";
    const auto plain = bodies(lines), colored = bodies(lines + "colors = [\"#ff0000\", \"#00ff00\", \"#0000ff\"]");
    EXPECT_EQ(numbers(plain), numbers(colored));
    std::map<std::string, int> uses;
    for (const BodyDescription& b : colored) ++uses[to_string(b.appearance.color)];
    EXPECT_EQ(uses.size(), 3u);
    for (const auto& [color, n] : uses) EXPECT_GT(n, 20) << color;
}

TEST(Grid, TwoTablesOfOneSceneDiffer) {
    const auto list = parse_scene(
                          "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 1 }\ngrid = { count = [1, 1, "
                          "1], spacing = 1, jitter = 1 }\n"
                          "[[body]]\nshape = { type = \"sphere\", radius = 1 }\ngrid = { count = [1, 1, 1], spacing = "
                          "1, jitter = 1 }",
                          "a.toml")
                          .bodies;
    EXPECT_NE(list[0].position, list[1].position);
}

TEST(Arrays, ScaleIsUniformWithinItsRange) {
    const auto list = bodies("grid = { count = [10, 10, 10], spacing = 8 }\nscale = [0.5, 2]");
    double least = 1e9, most = 0.0;
    for (const BodyDescription& b : list) {
        const Vec3 size = std::get<BoxShape>(b.shape).size;
        EXPECT_NEAR(size.y(), 2.0 * size.x(), 1e-12);
        EXPECT_NEAR(size.z(), 3.0 * size.x(), 1e-12);
        least = std::min(least, size.x());
        most = std::max(most, size.x());
    }
    EXPECT_GE(least, 0.5);
    EXPECT_LE(most, 2.0);
    EXPECT_LT(least, 0.55);
    EXPECT_GT(most, 1.95);
}

TEST(Arrays, MeshesOfOneSizeAreShared) {
    const std::string mesh = "{ type = \"mesh\", file = \"" TUMBLE_SOURCE_DIR "/assets/meshes/gem.obj\" }";
    std::set<const MeshAsset*> alike, sizes;
    for (const auto& b : bodies("grid = { count = [20, 20, 1], spacing = 4 }", 1, mesh)) {
        alike.insert(std::get<MeshShape>(b.shape).asset.get());
    }
    for (const auto& b : bodies("grid = { count = [20, 20, 1], spacing = 4 }\nscale = [0.5, 1]", 1, mesh)) {
        sizes.insert(std::get<MeshShape>(b.shape).asset.get());
    }
    EXPECT_EQ(alike.size(), 1u);
    EXPECT_EQ(sizes.size(), 9u);
}

/// The box that the error of a crowded scatter names: "(3 x 2 x 3 m is enough)".
std::string large_enough_box(const std::string& scatter, int seed, const std::string& shape) {
    try {
        bodies(scatter, seed, shape);
    } catch (const InputError& error) {
        const std::string text = error.message();
        EXPECT_NE(text.find("is too crowded: only "), std::string::npos) << text;
        const std::size_t first = text.find("make the box larger (") + 21, end = text.find(" m is enough)");
        if (end != std::string::npos) return text.substr(first, end - first);
        ADD_FAILURE() << text;
    }
    return "";
}

TEST(Scatter, NamesABoxThatIsLargeEnough) {
    for (const std::string shape : {"{ type = \"box\", size = [1, 2, 3] }", "{ type = \"sphere\", radius = 0.031 }",
                                    "{ type = \"box\", size = [70, 70, 70] }"})
        for (const std::string size : {"[1, 1, 1]", "[2, 0.01, 1]", "[0, 0.02, 0]", "[0, 0, 0]"})
            for (const int seed : {1, 2}) {
                const auto scatter = [](const std::string& box) {
                    return "scale = [0.5, 1]\nscatter = { count = 40, clearance = 0.1, size = " + box + " }";
                };
                const std::string box = large_enough_box(scatter(size), seed, shape);
                if (box.empty()) continue;  // it has failed
                std::string list = "[" + box + "]";
                for (std::size_t at; (at = list.find(" x ")) != std::string::npos;) list.replace(at, 3, ", ");
                EXPECT_EQ(bodies(scatter(list), seed, shape).size(), 40u) << list;
                EXPECT_LT(list.size(), 26u) << list;
            }
}

TEST(Scatter, StaysInItsBoxAndApart) {
    for (const std::string shape :
         {"{ type = \"box\", size = [0.3, 0.2, 0.5] }", "{ type = \"sphere\", radius = 0.3 }",
          "{ type = \"mesh\", file = \"" TUMBLE_SOURCE_DIR "/assets/meshes/t_handle.obj\", scale = 0.5 }"}) {
        const auto list = bodies(
            "position = [5, 10, 0]\nscatter = { count = 300, size = [8, 6, 4], clearance = 0.05 }\nscale = [0.5, 1]", 3,
            shape);
        ASSERT_EQ(list.size(), 300u);
        std::vector<BoundingSphere> spheres;  // world frame
        for (const BodyDescription& b : list) {
            const Vec3 offset = b.position - Vec3(5, 10, 0);
            EXPECT_LE(std::fabs(offset.x()), 4.0);
            EXPECT_LE(std::fabs(offset.y()), 3.0);
            EXPECT_LE(std::fabs(offset.z()), 2.0);
            const BoundingSphere own = bounding_sphere(b.shape);
            spheres.push_back({b.position + b.rotation * own.center, own.radius});
        }
        double nearest = 1e9;
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const double between = (spheres[i].center - spheres[j].center).norm();
                nearest = std::min(nearest, between - spheres[i].radius - spheres[j].radius);
            }
        }
        EXPECT_GE(nearest, 0.05) << shape;
        EXPECT_LT(nearest, 0.2) << shape;  // as near as allowed, not farther
    }
}

TEST(Scatter, TurnsItsCopiesUnlessAskedNotTo) {
    const auto flipped = bodies("scatter = { count = 200, size = [90, 90, 90] }");
    Vec3 mean = Vec3::Zero();
    for (const BodyDescription& b : flipped) mean += b.rotation * Vec3(0, 1, 0) / 200.0;
    EXPECT_LT(mean.norm(), 0.2);
    for (const BodyDescription& b :
         bodies("scatter = { count = 20, size = [90, 90, 90], rotation = \"none\" }\nrotation = [0, 1, 0, 0]")) {
        EXPECT_EQ(b.rotation.coeffs(), Quat(0, 1, 0, 0).coeffs());
    }
}

TEST(Scatter, TheSameSeedGivesTheSameBytesAndAnotherGivesOthers) {
    const std::string lines = "scatter = { count = 50, size = [30, 30, 30] }";
    EXPECT_EQ(numbers(bodies(lines, 1)), numbers(bodies(lines, 1)));
    EXPECT_NE(numbers(bodies(lines, 1)), numbers(bodies(lines, 2)));
}

TEST(Random, IsTheSameEverywhere) {  // mt19937_64 and the mixing are specified to the bit
    Random random(1, 0, Random::Purpose::position);
    EXPECT_EQ(random.unit(), 0.73236295993950207);
    EXPECT_EQ(random.unit(), 0.40196350523301438);
}

TEST(Random, RotationsAreUniform) {
    Random random(1, 2, Random::Purpose::rotation);
    Mat3 mean = Mat3::Zero();
    double small = 0.0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const Quat q = random.rotation();
        EXPECT_NEAR(q.norm(), 1.0, 4e-16);
        mean += q.toRotationMatrix() / count;
        small += q.angularDistance(Quat::Identity()) < M_PI / 2.0;
    }
    EXPECT_LT(mean.norm(), 0.03);
    // The angle has density (1 - cos a) / pi: a quarter turn or less has probability 1/2 - 1/pi.
    EXPECT_NEAR(small / count, 0.5 - 1.0 / M_PI, 0.01);
}

}  // namespace
}  // namespace tumble::arrays_test
