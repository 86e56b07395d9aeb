// Meshes in scenes: found relative to the scene file, and checked for the body that uses them.
#include "core/error.h"
#include "mesh_files.h"
#include "scene/load.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <sstream>
#include <string>
#include <vector>

namespace tumble::mesh_use_test {
namespace {

class MeshUse : public MeshFiles {
protected:
    std::string error_of(const std::string& body_lines) const {
        try {
            parse_scene("format = 1\n[[body]]\n" + body_lines, folder() / "scene.toml");
        } catch (const InputError& error) {
            const std::string text = error.what(), path = (folder() / "scene.toml").string();
            EXPECT_EQ(text.rfind(path, 0), 0u) << text;
            return text.substr(path.size());
        }
        return "no error";
    }
    MeshShape mesh_of(const std::string& body_lines) const {
        return std::get<MeshShape>(
            parse_scene("format = 1\n[[body]]\n" + body_lines, folder() / "scene.toml").bodies[0].shape);
    }
};

TEST_F(MeshUse, FilesAreFoundFromTheScenesFolder) {
    std::filesystem::create_directory(folder() / "scenes");
    write("cube.obj", cube_points() + cube_faces());
    const auto scene = parse_scene(
        "format = 1\n[[body]]\nshape = { type = \"mesh\", file = \"../cube.obj\", scale = 3 }\n"
        "[[body]]\ntype = \"fixed\"\nshape = { type = \"mesh\", file = \"../cube.obj\", scale = 3 }",
        folder() / "scenes" / "scene.toml");
    const auto& mesh = std::get<MeshShape>(scene.bodies[0].shape).asset;
    EXPECT_EQ(mesh->file, (folder() / "cube.obj").string());
    EXPECT_EQ(mesh->mesh.bounds().max, Vec3(3, 3, 3));
    EXPECT_EQ(mesh, std::get<MeshShape>(scene.bodies[1].shape).asset);
}

// The tetrahedron's edge from 1 to 2 has a corner in its middle on one side only; a triangle without area closes the
// gap.
TEST_F(MeshUse, AMeshThatASliverClosesHasItsMass) {
    write("sliver.obj",
          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.5 0.5 0\nf 1 3 5\nf 1 5 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 2 5 3\n");
    const SceneDescription scene = parse_scene(
        "format = 1\n[[body]]\nshape = { type = \"mesh\", file = \"sliver.obj\" }\n", folder() / "scene.toml");
    const auto& shape = std::get<MeshShape>(scene.bodies[0].shape);
    EXPECT_EQ(shape.mass_from, MassFrom::solid);
    EXPECT_EQ(shape.asset->mesh.triangles.size(), 5u);
    EXPECT_NEAR(mass_properties(shape, 6.0).mass, 1.0, 1e-12);
}

TEST_F(MeshUse, AnStlIsInItsUnitWithItsUpAxis) {
    write("box.obj", "v 0 0 0\nv 100 0 0\nv 0 200 0\nv 0 0 300\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    const auto bounds = [&](const std::string& keys) {
        return mesh_of("shape = { type = \"mesh\", file = \"box.obj\"" + keys + " }").asset->mesh.bounds();
    };
    EXPECT_EQ(bounds("").max, Vec3(100, 200, 300));
    EXPECT_LT((bounds(", unit = \"mm\"").max - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
    EXPECT_LT((bounds(", unit = \"in\", scale = 2").max - 5.08 * Vec3(1, 2, 3)).norm(), 1e-12);
    EXPECT_EQ(bounds(", up = \"z\"").max, Vec3(100, 300, 0));
    EXPECT_EQ(bounds(", up = \"z\"").min, Vec3(0, 0, -200));
    EXPECT_EQ(bounds(", up = \"x\"").max, Vec3(0, 100, 300));
    EXPECT_NE(error_of("shape = { type = \"mesh\", file = \"box.obj\", unit = \"furlong\" }").find("must be one of"),
              std::string::npos);
    std::filesystem::copy_file(asset("star.glb"), folder() / "star.glb");
    EXPECT_EQ(error_of("shape = { type = \"mesh\", file = \"star.glb\", up = \"z\" }"),
              ":3:50: error: up is for files that state no unit and no up axis, and this one does: take the body's "
              "rotation in place of up");
}

TEST_F(MeshUse, AMissingOrBrokenFileIsAnErrorAtItsName) {
    EXPECT_EQ(error_of("shape = { type = \"mesh\", file = \"none.obj\" }"),
              ":3:33: error: mesh \"none.obj\" does not exist (looked at " + (folder() / "none.obj").string() + ")");
    write("bad.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
    EXPECT_NE(error_of("shape = { type = \"mesh\", file = \"bad.obj\" }")
                  .find(":3:33: error: mesh \"bad.obj\" has no triangle with any area"),
              std::string::npos);
    EXPECT_EQ(error_of("shape = { type = \"mesh\" }"), ":3:9: error: a mesh needs \"file\" (not given)");
    EXPECT_EQ(error_of("shape = { type = \"mesh\", file = \"\" }"),
              ":3:33: error: file must not be empty (given \"\")");
}

// A box of 2 m without its lid.
TEST_F(MeshUse, AnOpenMeshHasTheMassOfItsHullOrOfItsSurface) {
    write("open.obj", cube_points() + "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    const auto shape = [](const std::string& keys) {
        return "shape = { type = \"mesh\", file = \"open.obj\"" + keys + " }";
    };
    const MeshShape guessed = mesh_of(shape(""));
    EXPECT_EQ(guessed.mass_from, MassFrom::hull);
    EXPECT_FALSE(guessed.chosen);
    EXPECT_NEAR(mass_properties(guessed, 2.0).mass, 16.0, 1e-12);
    const MeshShape shell = mesh_of(shape(", mass_from = \"shell\", thickness = 0.01"));
    EXPECT_TRUE(shell.chosen);
    const MassProperties p = mass_properties(shell, 100.0);  // 20 m^2 of 1 kg/m^2
    EXPECT_NEAR(p.mass, 20.0, 1e-12);
    EXPECT_NEAR(p.center_of_mass.z(), -4.0 / 20.0, 1e-12);  // the floor has 4 kg at -1 m
    // Four walls, 1 m from the axis, and the floor: m w^2/12 + m d^2, m (w^2 + w^2)/12.
    EXPECT_NEAR(p.inertia(2, 2), 4.0 * 4.0 * (4.0 / 12.0 + 1.0) + 4.0 * 8.0 / 12.0, 1e-12);
    EXPECT_EQ(
        error_of(shape(", mass_from = \"solid\"")),
        ":3:57: error: mass_from \"solid\" needs a closed mesh, and this one is open: 4 of its edges belong to one "
        "triangle only, so it encloses no volume; take \"hull\" or \"shell\", or close it (given \"solid\")");
    EXPECT_NE(error_of(shape(", mass_from = \"hull\", thickness = 0.1")).find("thickness is a key of shells"),
              std::string::npos);
    for (const char* type : {"fixed", "kinematic"})
        EXPECT_EQ(error_of(std::string("type = \"") + type + "\"\n" + shape("")), "no error");
}

TEST_F(MeshUse, AFlatMeshIsASheetAndCollidesAsAPlate) {
    write("sheet.obj", "v 0 0 0\nv 0 0 2\nv 1 0 2\nv 1 0 0\nf 1 2 3 4\n");
    const std::string shape = "shape = { type = \"mesh\", file = \"sheet.obj\"";
    const MeshShape sheet = mesh_of(shape + " }");
    EXPECT_EQ(sheet.mass_from, MassFrom::shell);
    EXPECT_DOUBLE_EQ(sheet.thickness, 0.02);
    const MassProperties p = mass_properties(sheet, 100.0);
    EXPECT_NEAR(p.mass, 4.0, 1e-12);
    EXPECT_NEAR(p.inertia(0, 0), 4.0 * 4.0 / 12.0, 1e-12);
    EXPECT_NEAR(p.inertia(1, 1), 4.0 * 5.0 / 12.0, 1e-12);
    EXPECT_NE(error_of(shape + ", mass_from = \"hull\" }").find("needs a mesh with a volume, and this one is flat"),
              std::string::npos);
    ColliderCache cache;
    const CollisionShape plate = make_collider(Shape(sheet), {false, p.center_of_mass, 100.0}, cache);
    const Bounds bounds = world_bounds(plate, Pose{});
    EXPECT_TRUE(bounds.max.isApprox(Vec3(0.5, 0.01, 1.0), 1e-12)) << bounds.max.transpose();
    EXPECT_TRUE(bounds.min.isApprox(Vec3(-0.5, -0.01, -1.0), 1e-12)) << bounds.min.transpose();
}

// Solids that touch at an edge or share a face enclose a volume; faces that are listed twice do not count twice.
TEST_F(MeshUse, TheVolumeOfSolidsThatTouchIsTheirSum) {
    write("hinge.obj",
          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 0 0 -1\n"  // two tetrahedra on one edge
          "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 5 2\nf 1 2 6\nf 1 6 5\nf 2 5 6\n");
    std::string faces, backs;  // triangles
    std::istringstream quads(cube_faces());
    std::string f;
    for (int a, b, c, d; quads >> f >> a >> b >> c >> d;) {
        faces += fmt::format("f {} {} {}\nf {} {} {}\n", a, b, c, a, c, d);
        backs += fmt::format("f {} {} {}\nf {} {} {}\n", a, c, b, a, d, c);
    }
    write("twice.obj", cube_points() + faces + faces);
    write("both_sides.obj", cube_points() + faces + backs);
    const auto loaded = [&](const std::string& file) {
        return mesh_of("shape = { type = \"mesh\", file = \"" + file + "\" }");
    };
    EXPECT_NEAR(mass_properties(loaded("hinge.obj"), 1.0).mass, 2.0 / 6.0, 1e-12);
    for (const char* file : {"twice.obj", "both_sides.obj"}) {
        const MeshShape mesh = loaded(file);
        EXPECT_EQ(mesh.mass_from, MassFrom::solid) << file;
        EXPECT_EQ(mesh.asset->doubled_faces, 12u) << file;
        EXPECT_NEAR(mass_properties(mesh, 1.0).mass, 8.0, 1e-12) << file;
    }
}

TEST_F(MeshUse, FacesThatDisagreeAreTurned) {
    write("turned.obj", cube_points() + "f 1 4 3 2\nf 8 7 6 5\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    EXPECT_EQ(error_of("shape = { type = \"mesh\", file = \"turned.obj\" }"), "no error");
}

TEST_F(MeshUse, ScaleIsLimited) {
    write("cube.obj", cube_points() + cube_faces());
    EXPECT_EQ(error_of("shape = { type = \"mesh\", file = \"cube.obj\", scale = 0 }"),
              ":3:53: error: scale must be from 1e-09 to 1000000000 (given 0)");
    EXPECT_NE(error_of("shape = { type = \"mesh\", file = \"cube.obj\", scale = 9e8 }")
                  .find(":3:53: error: scale makes a mesh of unusable size"),
              std::string::npos);
}

}  // namespace
}  // namespace tumble::mesh_use_test
