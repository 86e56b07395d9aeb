// Mesh files of the formats that assimp imports in a child process: the same shapes, and no harm from malformed files.
#include "mesh_files.h"
#include "scene/mesh/mesh_loader.h"
#include "scene/mesh/three_mf_unit.h"

#include <fmt/format.h>
#include <sys/stat.h>

namespace tumble::assimp_import_test {
namespace {

class AssimpImport : public MeshFiles {
protected:
    std::string error_of(const std::string& name, const std::string& text) const {
        try {
            load_mesh(write(name, text));
        } catch (const MeshError& error) {
            return error.what();
        }
        return "no error";
    }
};

std::string collada(const std::string& nodes) {
    return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
           "<asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh>"
           "<source id=\"p\"><float_array id=\"a\" count=\"12\">0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common>"
           "<accessor source=\"#a\" count=\"4\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
           "type=\"float\"/>"
           "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
           "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
           "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
           "<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>"
           "<library_visual_scenes><visual_scene id=\"s\">" +
           nodes +
           "</visual_scene></library_visual_scenes>"
           "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

TEST_F(AssimpImport, ACubeOfOff) {
    const LoadedMesh mesh =
        load_mesh(write("cube.off",
                        "OFF\n8 6 12\n-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n"
                        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"));
    EXPECT_EQ(mesh.asset->mesh.triangles.size(), 12u);
    EXPECT_DOUBLE_EQ(mesh.closedness.signed_volume, 8.0);
}

/// A tetrahedron with the edges 1, 2, 3 along x, y, z, in inches with z up.
std::string fbx(int up_axis) {
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\nGlobalSettings:  {\n"
           "\tVersion: 1000\n\tProperties70:  {\n\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\"," +
           std::to_string(up_axis) + "\n\t\tP: \"FrontAxis\", \"int\", \"Integer\", \"\"," +
           std::to_string(3 - up_axis) + "\n\t\tP: \"FrontAxisSign\", \"int\", \"Integer\", \"\"," +
           (up_axis == 2 ? "-1" : "1") +
           "\n\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",2.54\n\t}\n}\n"
           "Objects:  {\n\tGeometry: 100, \"Geometry::g\", \"Mesh\" {\n"
           "\t\tVertices: *12 {\n\t\t\ta: 0,0,0,1,0,0,0,2,0,0,0,3\n\t\t}\n"
           "\t\tPolygonVertexIndex: *12 {\n\t\t\ta: 0,2,-2,0,1,-4,1,2,-4,2,0,-4\n\t\t}\n\t}\n"
           "\tModel: 200, \"Model::m\", \"Mesh\" {\n\t\tVersion: 232\n\t}\n}\n"
           "Connections:  {\n\tC: \"OO\",200,0\n\tC: \"OO\",100,200\n}\n";
}

TEST_F(AssimpImport, FbxHasItsUnitAndItsUpAxis) {
    const Bounds upright = load_mesh(write("y.fbx", fbx(1))).asset->mesh.bounds();
    EXPECT_LT((upright.extent() - 0.0254 * Vec3(1.0, 2.0, 3.0)).norm(), 1e-9);
    const LoadedMesh turned = load_mesh(write("z.fbx", fbx(2)));
    const Bounds bounds = turned.asset->mesh.bounds();
    EXPECT_LT((bounds.min - 0.0254 * Vec3(0.0, 0.0, -2.0)).norm(), 1e-9);
    EXPECT_LT((bounds.max - 0.0254 * Vec3(1.0, 3.0, 0.0)).norm(), 1e-9);
    EXPECT_TRUE(turned.encloses());  // not mirrored
    EXPECT_TRUE(turned.in_meters);
}

// The archive has one stored file, and no more of a 3MF package than the search for the unit needs.
TEST_F(AssimpImport, TheUnitOfA3mfIsThatOfItsModel) {
    const auto archive = [](const std::string& model) {
        const std::string name = "3D/3dmodel.model";
        const auto number = [](std::size_t value, int bytes) {
            std::string text;
            for (int i = 0; i < bytes; ++i) text += char(value >> (8 * i) & 0xff);
            return text;
        };
        const std::string sizes = number(model.size(), 4) + number(model.size(), 4) + number(name.size(), 2);
        const std::string local = std::string("PK\3\4") + std::string(14, '\0') + sizes + number(0, 2) + name + model;
        return local + "PK\1\2" + std::string(16, '\0') + sizes + std::string(16, '\0') + name;
    };
    EXPECT_EQ(three_mf_unit(archive("<model unit=\"inch\"><build/></model>")), 0.0254);
    EXPECT_EQ(three_mf_unit(archive("<model xml:lang='en' unit='meter'>")), 1.0);
    EXPECT_EQ(three_mf_unit(archive("<model><object unit=\"meter\"/></model>")), 0.001);
    EXPECT_EQ(three_mf_unit("PK\1\2"), 0.001);
}

TEST_F(AssimpImport, NodesOfColladaAreObjectsWithTheirTransforms) {
    const std::string use = "<instance_geometry url=\"#g\"/></node>";
    const auto file = write(
        "two.dae",
        collada("<node id=\"one\">" + use + "<node id=\"two\"><translate>0 5 0</translate><scale>2 2 2</scale>" + use));
    const auto objects = load_mesh_objects(file);
    ASSERT_EQ(objects.size(), 2u);
    EXPECT_NEAR(objects[0].closedness.signed_volume, 1.0 / 6.0, 1e-15);
    EXPECT_NEAR(objects[1].closedness.signed_volume, 8.0 / 6.0, 1e-14);
    EXPECT_EQ(objects[1].asset->mesh.bounds().center(), Vec3(1.0, 6.0, 1.0));
}

TEST_F(AssimpImport, NoOtherFileIsOpened) {
    ASSERT_EQ(mkfifo((folder() / "fifo.obj").c_str(), 0600), 0);  // opening it would wait
    const std::string scene =
        "<?xml version=\"1.0\"?><irr_scene><node type=\"mesh\"><attributes>"
        "<string name=\"Mesh\" value=\"fifo.obj\"/></attributes></node></irr_scene>";
    EXPECT_NE(error_of("scene.irr", scene), "no error");
}

TEST_F(AssimpImport, MoreThanItHolds) {
    EXPECT_NE(error_of("promise.off", "OFF\n2000000000 2000000000 0\n0 0 0\n"), "no error");
    EXPECT_NE(error_of("cut.off", "OFF\n8 6 12\n-1 -1"), "no error");
}

TEST_F(AssimpImport, ACrashIsAnError) {
    std::string nodes, ends;
    for (int i = 0; i < 200'000; ++i) {  // its reader of nodes is recursive
        nodes += "<node>";
        ends += "</node>";
    }
    const std::string error = error_of("deep.dae", collada(nodes + "<instance_geometry url=\"#g\"/>" + ends));
    EXPECT_NE(error, "no error");
    EXPECT_LT(error.size(), 300u);
}

}  // namespace
}  // namespace tumble::assimp_import_test
