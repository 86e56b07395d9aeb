// Shapes from numbers: hulls of points, and height fields from PNG and CSV files with each of their errors.
#include "core/error.h"
#include "scene/load.h"
#include "scene/mesh/height_grid.h"
#include "sim/geometry/shapes/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace tumble::made_shapes_test {
namespace {

namespace fs = std::filesystem;

const fs::path source = TUMBLE_SOURCE_DIR;
const fs::path folder = fs::path(::testing::TempDir()) / "made_shapes";

SceneDescription load(const std::string& body, FileList* read = nullptr) {
    return parse_scene("format = 1\n[[body]]\n" + body, folder / "scene.toml", {}, read);
}

SceneDescription field(const std::string& heights, const std::string& keys, FileList* read = nullptr) {
    fs::create_directories(folder);
    std::ofstream(folder / "heights.csv", std::ios::binary) << heights;
    return load("type = \"fixed\"\nshape = { type = \"heightfield\", file = \"heights.csv\", " + keys + " }\n", read);
}

std::string error_of(const std::string& heights, const std::string& keys = "size = [2, 2], height = 1") {
    try {
        field(heights, keys);
    } catch (const InputError& error) {
        std::string text = error.what();
        if (text.starts_with(folder.string())) text.erase(0, folder.string().size() + 1);
        return text;
    }
    return "no error";
}

const MeshAsset& asset_of(const SceneDescription& scene) {
    return *std::get<MeshShape>(scene.bodies.back().shape).asset;
}

TEST(HullShape, IsTheConvexHullOfItsPoints) {
    const SceneDescription scene = load(
        "density = 500\nshape = { type = \"hull\", points = [[0, 0, 0], [1, 0, 0], [0, 2, 0], [1, 2, 0], [0, 0, 3], "
        "[1, 0, 3], [0, 2, 3], [1, 2, 3], [0.5, 0.5, 0.5], [0.5, 1, 1.5]] }\n");
    EXPECT_EQ(asset_of(scene).mesh.vertices.size(), 8u) << "points inside are no corners";
    EXPECT_EQ(asset_of(scene).mesh.triangles.size(), 12u);
    const MassProperties mass = mass_properties(scene.bodies[0]), box = mass_properties(BoxShape{{1, 2, 3}}, 500.0);
    EXPECT_NEAR(mass.mass, box.mass, 1e-9);
    EXPECT_LT((mass.center_of_mass - Vec3(0.5, 1.0, 1.5)).norm(), 1e-12);
    EXPECT_LT((mass.inertia - box.inertia).norm(), 1e-9);
}

TEST(HullShape, IsEnlargedInCopies) {
    const SceneDescription scene = load(
        "shape = { type = \"hull\", points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }\n"
        "grid = { count = [2, 1, 1], spacing = 9 }\nscale = [2, 2]\n");
    ASSERT_EQ(scene.bodies.size(), 2u);
    EXPECT_EQ(local_bounds(scene.bodies[1].shape).max, Vec3(2, 2, 2));
    EXPECT_EQ(shared_data(scene.bodies[0].shape), shared_data(scene.bodies[1].shape));
}

TEST(HeightField, HasTheHeightsOfItsFileAndIsSolidBelow) {
    FileList read;
    const SceneDescription scene = field(
        "\xEF\xBB\xBF"
        "0, 1 ,2\r\n\n3,4,5\n",
        "size = [4, 3], height = 0.5, base = 0.25", &read);
    const TriangleMesh& mesh = asset_of(scene).mesh;
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 3; ++column) {
            const Vec3 corner(2.0 * column - 2.0, 0.5 * (3 * row + column), 3.0 * row - 1.5);
            EXPECT_NE(std::find(mesh.vertices.begin(), mesh.vertices.end(), corner), mesh.vertices.end());
        }
    EXPECT_EQ(mesh.bounds().min, Vec3(-2.0, -0.25, -1.5));
    const Closedness closed = closedness(mesh);
    EXPECT_TRUE(closed.closed());
    EXPECT_NEAR(closed.signed_volume, 4.0 * 3.0 * (0.25 + 0.5 * 2.5), 1e-12) << "the mean height is 2.5";
    EXPECT_NE(std::find(read.begin(), read.end(), folder / "heights.csv"), read.end());
    EXPECT_EQ(asset_of(field("0,0\n0,0\n", "size = [4, 3], height = 1")).mesh.bounds().min.y(), -0.2);
}

TEST(HeightField, ReadsAllBitsOfAPngFile) {
    const HeightGrid grid = read_height_grid(source / "assets/heights/marble_run.png");
    EXPECT_EQ(grid.columns, 281);
    EXPECT_EQ(grid.rows, 161);
    EXPECT_GE(*std::min_element(grid.heights.begin(), grid.heights.end()), 0.0);
    EXPECT_LE(*std::max_element(grid.heights.begin(), grid.heights.end()), 1.0);
    const auto fine = std::count_if(grid.heights.begin(), grid.heights.end(),
                                    [](double height) { return std::lround(65535.0 * height) % 257 != 0; });
    EXPECT_GT(fine, 40'000);
}

TEST(HeightField, ErrorsHaveThePlaceInTheFile) {
    EXPECT_EQ(error_of("0,1\n2,x\n"),
              "heights.csv:2:3: error: a height must be a number from -1000000000 to 1000000000 (given \"x\")");
    EXPECT_EQ(error_of("0,1\n2, nan\n"),
              "heights.csv:2:4: error: a height must be a number from -1000000000 to 1000000000 (given \"nan\")");
    EXPECT_EQ(error_of("0,1\n2,\n"),
              "heights.csv:2:3: error: a height must be a number from -1000000000 to 1000000000 (given \"\")");
    EXPECT_EQ(error_of("0,1\n2,3,4\n"),
              "heights.csv:2:1: error: a row of heights has as many numbers as the first, 2 (given 3)");
    EXPECT_EQ(error_of("0,1\n"), "heights.csv: error: a height field needs 2 x 2 heights at least (given 2 x 1)");
    EXPECT_EQ(error_of(""), "heights.csv: error: a height field needs 2 x 2 heights at least (given 0 x 0)");
    EXPECT_NE(error_of("0,1e9\n0,0\n", "size = [1, 1], height = 2").find("outside of"), std::string::npos);
    EXPECT_NE(error_of("\x89PNG\r\n\x1a\n").find("not a whole PNG file"), std::string::npos);
}

TEST(HeightField, RefusesColors) {
    const fs::path frames = source / "docs/pictures/edges.png";
    try {
        read_height_grid(frames);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.message(), "the picture must be gray, without colors and without alpha");
    }
}

}  // namespace
}  // namespace tumble::made_shapes_test
