// Meshes in scenes: found relative to the scene file, and checked for the body that uses them.
#include "core/error.h"
#include "mesh_files.h"
#include "scene/load.h"

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

TEST_F(MeshUse, AnOpenMeshMayBeFixedButNotDynamic) {
    write("open.obj", cube_points() + "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    const std::string shape = "shape = { type = \"mesh\", file = \"open.obj\" }";
    EXPECT_EQ(error_of(shape),
              ":3:33: error: file is an open mesh: 4 of its edges belong to one triangle only, so it encloses no "
              "volume and has no mass; close it, or use it with type = \"fixed\" (given \"open.obj\")");
    EXPECT_EQ(error_of("type = \"fixed\"\n" + shape), "no error");
    EXPECT_EQ(error_of("type = \"kinematic\"\n" + shape), "no error");
}

TEST_F(MeshUse, FacesThatDisagreeAreTurned) {
    write("turned.obj", cube_points() + "f 1 4 3 2\nf 8 7 6 5\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    EXPECT_EQ(error_of("shape = { type = \"mesh\", file = \"turned.obj\" }"), "no error");
}

TEST_F(MeshUse, FacesThatMeetByFoursAreNoSolid) {
    write("hinge.obj",
          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 0 0 -1\n"  // two tetrahedra on one edge
          "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 5 2\nf 1 2 6\nf 1 6 5\nf 2 5 6\n");
    EXPECT_NE(error_of("shape = { type = \"mesh\", file = \"hinge.obj\" }").find("more than two triangles meet"),
              std::string::npos);
}

TEST_F(MeshUse, AClosedSheetIsNoSolid) {
    write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 3 2 1\n");
    EXPECT_NE(error_of("shape = { type = \"mesh\", file = \"sheet.obj\" }").find("encloses no volume"),
              std::string::npos);
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
