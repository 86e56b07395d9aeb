// Compounds in scene files: results, and errors with their positions.
#include "core/error.h"
#include "mesh_files.h"
#include "scene/load.h"
#include "scene/mesh/mesh_loader.h"
#include "sim/geometry/shapes/shape.h"

#include <algorithm>

namespace tumble::compound_test {
namespace {

class Compounds : public MeshFiles {
protected:
    SceneDescription parsed(const std::string& body_lines) const {
        return parse_scene("format = 1\n[[body]]\n" + body_lines, folder() / "scene.toml");
    }
    const std::vector<CompoundPart>& parts(const SceneDescription& scene, std::size_t body = 0) const {
        return *std::get<CompoundShape>(scene.bodies[body].shape).parts;
    }
    /// An @ marks the position of the error; it is removed.
    void expect_error(const std::string& marked, const std::string& phrase) const {
        const std::size_t mark = marked.find('@');
        const std::string before = marked.substr(0, mark);
        const auto line = 3 + std::count(before.begin(), before.end(), '\n');
        const std::size_t column = mark - (before.rfind('\n') == std::string::npos ? 0 : before.rfind('\n') + 1) + 1;
        const std::string place = (folder() / "scene.toml").string() + ":" + std::to_string(line) + ":" +
                                  std::to_string(column) + ": error: ";
        std::string error = "no error";
        try {
            parsed(before + marked.substr(mark + 1));
        } catch (const InputError& e) {
            error = e.what();
        }
        EXPECT_EQ(error.substr(0, place.size()), place) << error;
        EXPECT_NE(error.find(phrase), std::string::npos) << error;
    }
};

TEST_F(Compounds, PartsHaveShapesPlacesAndDensities) {
    const SceneDescription scene = parsed(R"(density = 500.0
shape = { type = "compound", parts = [
  { shape = { type = "box", size = [1, 2, 3] }, position = [4, 5, 6], rotation = { axis = [0, 1, 0], angle = 90 } },
  { shape = { type = "sphere", radius = 0.5 }, density = 7800.0, color = "#ff0000" },
] })");
    const auto& list = parts(scene);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(std::get<BoxShape>(list[0].shape).size, Vec3(1, 2, 3));
    EXPECT_EQ(list[0].position, Vec3(4, 5, 6));
    EXPECT_LT((list[0].rotation * Vec3(1, 0, 0) - Vec3(0, 0, -1)).norm(), 1e-15);
    EXPECT_FALSE(list[0].density || list[0].color);
    EXPECT_EQ(std::get<SphereShape>(list[1].shape).radius, 0.5);
    EXPECT_EQ(list[1].density, 7800.0);
    EXPECT_EQ(list[1].color->r, 255);
    EXPECT_EQ(scene.bodies[0].density, 500.0);
    // The rotated box is 3 x 2 x 1.
    const Bounds bounds = local_bounds(scene.bodies[0].shape);
    EXPECT_LT((bounds.min - Vec3(-0.5, -0.5, -0.5)).norm(), 1e-14);
    EXPECT_LT((bounds.max - Vec3(5.5, 6.0, 6.5)).norm(), 1e-14);
    const BoundingSphere ball = bounding_sphere(scene.bodies[0].shape);
    EXPECT_NEAR(ball.radius, (Vec3(5.5, 6.0, 6.5) - ball.center).norm(), 1e-14);
}

TEST_F(Compounds, NestedCompoundsAreFlattened) {
    const SceneDescription scene = parsed(
        R"(shape = { type = "compound", parts = [ { position = [0, 0, 1], rotation = { axis = [0, 0, 1], angle = 90 }, density = 2.0, shape = { type = "compound", parts = [
    { shape = { type = "box", size = [1, 1, 1] }, position = [1, 0, 0] },
    { shape = { type = "box", size = [1, 1, 1] }, position = [2, 0, 0], density = 3.0 } ] } } ] })");
    const auto& list = parts(scene);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_LT((list[0].position - Vec3(0, 1, 1)).norm(), 1e-15);
    EXPECT_LT((list[1].position - Vec3(0, 2, 1)).norm(), 1e-15);
    EXPECT_EQ(list[0].density, 2.0);
    EXPECT_EQ(list[1].density, 3.0);
}

TEST_F(Compounds, ObjectsOfAMeshFileArePartsAndShared) {
    write("two.obj", "o first\n" + cube_points() + cube_faces() + "o second\nv 3 0 0\nv 4 0 0\nv 3 1 0\nv 3 0 1\n" +
                         "f 9 11 10\nf 9 10 12\nf 10 11 12\nf 9 12 11\n");
    const std::string shape = "shape = { type = \"mesh\", file = \"two.obj\", scale = 2.0, parts = \"objects\" }\n";
    const SceneDescription scene = parsed(shape + "[[body]]\ntype = \"fixed\"\n" + shape);
    const auto& list = parts(scene);
    ASSERT_EQ(list.size(), 2u);
    const MeshAsset& cube = *std::get<MeshShape>(list[0].shape).asset;
    EXPECT_EQ(cube.mesh.vertices.size(), 8u);
    EXPECT_EQ(cube.mesh.bounds().max, Vec3(2, 2, 2));
    EXPECT_EQ(std::get<MeshShape>(list[1].shape).asset->mesh.vertices.size(), 4u);
    EXPECT_EQ(local_bounds(scene.bodies[0].shape).max, Vec3(8, 2, 2));
    EXPECT_EQ(&cube, std::get<MeshShape>(parts(scene, 1)[0].shape).asset.get());
}

TEST_F(Compounds, TheHoopIsMadeOfConvexParts) {
    const auto objects = load_mesh_objects(asset("hoop.obj"));
    ASSERT_EQ(objects.size(), 24u);
    for (const LoadedMesh& object : objects) {
        EXPECT_TRUE(object.closedness.closed());
        const TriangleMesh& mesh = object.asset->mesh;
        for (const auto& t : mesh.triangles) {
            const Vec3& a = mesh.vertices[t[0]];
            const Vec3 n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
            for (const Vec3& v : mesh.vertices) EXPECT_LT(n.dot(v - a), 1e-6);
        }
    }
}

TEST_F(Compounds, CopiesAreScaledWithTheirPlaces) {
    const SceneDescription scene = parsed(R"(shape = { type = "compound", parts = [
  { shape = { type = "box", size = [1, 1, 1] }, position = [1, 0, 0] }, { shape = { type = "sphere", radius = 1 } } ] }
grid = { count = [50, 1, 1], spacing = 9.0 }
scale = [2.0, 2.0]
colors = ["#102030"])");
    ASSERT_EQ(scene.bodies.size(), 50u);
    EXPECT_EQ(parts(scene, 0)[0].position, Vec3(2, 0, 0));
    EXPECT_EQ(std::get<BoxShape>(parts(scene, 0)[0].shape).size, Vec3(2, 2, 2));
    EXPECT_EQ(std::get<SphereShape>(parts(scene, 0)[1].shape).radius, 2.0);
    EXPECT_EQ(&parts(scene, 0), &parts(scene, 49)) << "copies of one size share their parts";
}

TEST_F(Compounds, MistakesAreErrorsAtTheirPlace) {
    write("cube.obj", cube_points() + cube_faces());
    write("open.obj", "o whole\n" + cube_points() + cube_faces() + "o torn\n" + cube_points() + "f 9 12 11 10\n");
    const std::string head = "shape = { type = \"compound\", parts = ";
    expect_error("shape = @{ type = \"compound\" }", "a compound needs \"parts\" (not given)");
    expect_error(head + "@[] }", "parts must hold at least one part");
    expect_error(head + "@3 }", "parts must be an array of tables");
    expect_error(head + "[ @{ } ] }", "a part needs \"shape\" (not given)");
    expect_error(head + "[ { shape = { type = @\"plane\" } } ] }", "\"plane\" is endless and cannot be part of a body");
    expect_error(head + "[ { shape = { type = \"box\", size = [1, @0, 1] } } ] }", "size must be");
    expect_error(head + "[ { shape = { type = \"sphere\", radius = 1 }, @postion = [0, 0, 0] } ] }",
                 "did you mean \"position\"?");
    expect_error(head +
                     "[ { shape = { type = \"sphere\", radius = 1 } },\n { shape = { type = \"sphere\", radius = 1 }, "
                     "position = @[0, 0] } ] }",
                 "position must be");
    expect_error(head + "[ { shape = { type = \"sphere\", radius = 1 }, density = @0.0 } ] }", "density must be");
    expect_error(head + "[ { shape = { type = \"sphere\", radius = 1 }, rotation = @[1, 1, 0, 0] } ] }", "rotation");
    expect_error("shape = { type = \"mesh\", file = \"cube.obj\", parts = @\"groups\" }", "parts");
    expect_error("shape = { type = \"mesh\", file = \"open.obj\", parts = \"objects\", mass_from = @\"solid\" }",
                 "object 2 of the file is open: 4 of its edges");
    expect_error("shape = { type = \"mesh\", file = @\"none.obj\", parts = \"objects\" }", "does not exist");
    std::string many = head + "@[ ";
    for (int i = 0; i < 513; ++i) many += "{ shape = { type = \"sphere\", radius = 1 } }, ";
    expect_error(many.replace(many.find('@'), 1, "").insert(head.size(), "@") + "] }", "the limit of a body is 512");
}

}  // namespace
}  // namespace tumble::compound_test
