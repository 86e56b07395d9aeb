// Mesh files of the formats that other libraries import in a child process: the same shapes, and no harm from malformed
// files.
#include "mesh_files.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/mesh_loader.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <zlib.h>

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

/// A 3MF package, whose files are stored.
std::string three_mf(const std::string& model) {
    const auto number = [](std::size_t value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i) text += char(value >> (8 * i) & 0xff);
        return text;
    };
    const std::pair<std::string, std::string> files[] = {
        {"[Content_Types].xml",
         "<?xml version=\"1.0\" encoding=\"UTF-8\"?><Types "
         "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default Extension=\"rels\" "
         "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default Extension=\"model\" "
         "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
        {"_rels/.rels",
         "<?xml version=\"1.0\" encoding=\"UTF-8\"?><Relationships "
         "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
         "Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
         "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
        {"3D/3dmodel.model", model}};
    std::string archive, directory;
    for (const auto& [name, content] : files) {
        const auto sum = ::crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size()));
        const std::string common = number(20, 2) + std::string(8, '\0') + number(sum, 4) + number(content.size(), 4) +
                                   number(content.size(), 4) + number(name.size(), 2) + number(0, 2);
        directory += "PK\1\2" + number(20, 2) + common + std::string(10, '\0') + number(archive.size(), 4) + name;
        archive += "PK\3\4" + common + name + content;
    }
    const std::string end = "PK\5\6" + std::string(4, '\0') + number(std::size(files), 2) +
                            number(std::size(files), 2) + number(directory.size(), 4) + number(archive.size(), 4) +
                            number(0, 2);
    return archive + directory + end;
}

/// A tetrahedron with three edges of length 1 along the axes, twice: as it is, and 10 farther along x as a component.
std::string tetrahedra(const std::string& attributes, const std::string& of_triangles = "") {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><model " + attributes +
           " xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
           "<basematerials id=\"3\"><base name=\"red\" displaycolor=\"#FF0000\"/></basematerials>"
           "<object id=\"1\" type=\"model\" " +
           of_triangles +
           "><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" "
           "y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles>"
           "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" "
           "v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>"
           "<object id=\"2\" type=\"model\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 0 "
           "0\"/></components></object></resources><build><item objectid=\"1\"/><item objectid=\"2\"/></build></model>";
}

TEST_F(AssimpImport, A3mfHasItsUnitItsComponentsAndItsColors) {
    for (const auto& [unit, meters] : {std::pair{"unit=\"inch\"", 0.0254}, {"unit=\"meter\"", 1.0}, {"", 0.001}}) {
        const std::filesystem::path file = write("two.3mf", three_mf(tetrahedra(unit, "pid=\"3\" pindex=\"0\"")));
        const MeshFile mesh = read_mesh_file(file);
        ASSERT_EQ(mesh.triangles.size(), 8u);
        EXPECT_EQ(mesh.objects, (std::vector<std::size_t>{0, 4}));
        EXPECT_TRUE(mesh.in_meters);
        Bounds bounds;
        for (const Vec3& position : mesh.positions) bounds.add(position);
        EXPECT_NEAR((bounds.min - meters * Vec3(0, 0, -1)).norm(), 0.0, 1e-9 * meters) << unit;  // z is up in the file
        EXPECT_NEAR((bounds.max - meters * Vec3(11, 1, 0)).norm(), 0.0, 1e-6 * meters) << unit;
        EXPECT_TRUE(mesh.colored);
        EXPECT_EQ(mesh.triangles[0][0].color, (std::array<float, 3>{1.0f, 0.0f, 0.0f}));
    }
}

TEST_F(AssimpImport, ABroken3mfIsAnErrorOfItsReader) {
    const std::string whole = three_mf(tetrahedra("unit=\"meter\""));
    for (const std::string& bytes : {whole.substr(0, whole.size() / 2), std::string("PK\3\4"), three_mf("<model>")}) {
        const std::filesystem::path file = write("broken.3mf", bytes);
        EXPECT_THROW(read_mesh_file(file), MeshError);
    }
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
