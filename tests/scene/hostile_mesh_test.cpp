// Files that are broken, by accident or on purpose: an error each, no crash, no endless loop, no output.
#include "mesh_files.h"
#include "scene/mesh/mesh_loader.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <array>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace tumble::hostile_mesh_test {
namespace {

class HostileMesh : public MeshFiles {
protected:
    std::string error_of(const std::filesystem::path& file) const {
        try {
            load_mesh(file);
        } catch (const MeshError& error) {
            return error.what();
        }
        return "no error";
    }
    void expect_error(const std::string& name, const std::string& text, const std::string& phrase) const {
        const std::string error = error_of(write(name, text));
        EXPECT_NE(error.find(phrase), std::string::npos) << name << ": " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos);
        EXPECT_LT(error.size(), 300u);
    }
};

TEST_F(HostileMesh, OtherFilesAreRefused) {
    EXPECT_EQ(error_of(folder() / "none.obj"), "does not exist");
    EXPECT_EQ(error_of(folder()),
              "is of an unknown kind: .obj, .stl, .ply, .gltf, .glb and the kinds that assimp reads can be used");
    std::filesystem::create_directory(folder() / "folder.obj");
    EXPECT_EQ(error_of(folder() / "folder.obj"), "is a folder, not a file");
    expect_error("a.obj", "", "is empty");
    expect_error("a.ply", "", "is empty");
    expect_error("a.blend", "x", "cannot be read");
    expect_error("a.fbx", "x", "cannot be read");
    expect_error("a.cpp", "x", "unknown kind");
}

TEST_F(HostileMesh, AFifoOrADeviceIsNotWaitedOn) {
    ASSERT_EQ(mkfifo((folder() / "fifo.obj").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", folder() / "zero.ply");
    for (const char* name : {"fifo.obj", "zero.ply"})
        EXPECT_EQ(error_of(folder() / name), "is not a regular file") << name;
}

TEST_F(HostileMesh, AnObjOpensNoOtherFile) {
    ASSERT_EQ(mkfifo((folder() / "fifo.mtl").c_str(), 0600), 0);
    for (const char* name : {"fifo.mtl", "/etc/passwd", "/dev/zero", "none.mtl"})
        EXPECT_EQ(
            error_of(write("a.obj", fmt::format("mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl root\nf 1 2 3\n", name))),
            "no error");
}

TEST_F(HostileMesh, Obj) {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expect_error("a.obj", "nothing of a mesh in here at all\n", "no triangles");
    expect_error("a.obj", points, "no triangles");
    expect_error("a.obj", points + "f 1 2 4\n", "a face with vertex 4 of 3");
    expect_error("a.obj", points + "f 1 2 -9\n", "a face with vertex -9 of 3");
    expect_error("a.obj", points + "f 1 2 0\n", "a face with vertex 0 of 3");
    expect_error("a.obj", points + "f 1 2 3x\n", "a face with vertex 3x of 3");
    expect_error("a.obj", points + "f 1 2 99999999999999999999\n", "a face with vertex 99999999999999999999 of 3");
    expect_error("a.obj", points + "f 1 2 " + std::string(100'000, '\033') + "\n",
                 "vertex ????????????????????... of 3");
    expect_error("a.obj", points + "vn 0 0 1\nf 1//1 2//1 3//2\n", "a face with normal 2 of 1");
    expect_error("a.obj", "v 0 0 0\nv 1 0\n", "not a number, in line 2");
    expect_error("a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "finite");
    expect_error("a.obj", "v 1e39 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "finite");
    expect_error("a.obj", "v 1e999999999999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "finite");
    expect_error("a.obj", "v 1 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "finite");
    expect_error("a.obj", "v 1e31 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1e30");
    expect_error("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle with any area");
    expect_error("a.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", "no triangle with any area");
    expect_error("a.obj", points + "l 1 2\np 3\n", "no triangles");
    std::string polygon = points + "f";
    for (int i = 0; i < 3000; ++i) polygon += fmt::format(" {}", i % 3 + 1);
    expect_error("a.obj", polygon + "\n", "a polygon of more than 2000 corners");
}

TEST_F(HostileMesh, AHundredThousandObjectsAreRefusedWithoutMakingThem) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 100'000; ++i) text += fmt::format("o part{}\nf 1 2 3\n", i);
    const auto file = write("many.obj", text);
    std::string error = "no error";
    try {
        load_mesh_objects(file);
    } catch (const MeshError& e) {
        error = e.what();
    }
    EXPECT_EQ(error, "holds 100000 objects (a body has 512 parts at most)");
    EXPECT_EQ(load_mesh(file).asset->doubled_faces, 99'999u);
}

TEST_F(HostileMesh, Ply) {
    const std::string start = "ply\nformat ascii 1.0\n";
    const std::string points = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    expect_error("a.ply", "plx\n", "does not begin with \"ply\"");
    expect_error("a.ply", start + points, "ends within its header");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0", "ends early");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0 0\n0 1 0\n", "ends early");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a face with a vertex of 3");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "a face with a vertex of -1");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 nan\n", "a face with a vertex of nan");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n", "a list with a length");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n", "finite");
    expect_error("a.ply", start + points + faces + "0 0 0\n1 0 zero\n0 0 0\n3 0 1 2\n", "not a number");
    expect_error("a.ply", start + "element vertex 3\nproperty half x\nend_header\n", "unknown type");
    expect_error("a.ply", start + "element vertex 3\nproperty float x\nend_header\n", "without x, y and z");
    expect_error("a.ply", start + points + "element face 1\nproperty int x\nend_header\n0 0 0\n1 0 0\n0 1 0\n",
                 "without vertex_indices");
    expect_error("a.ply", start + "property float x\nend_header\n", "misplaced");
    expect_error("a.ply", "ply\nformat base64 1.0\nend_header\n", "unknown format");
    expect_error("a.ply",
                 "ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\nproperty float x\n"
                 "property float y\nproperty float z\nend_header\n1234",
                 "ends early");
    expect_error("a.ply",
                 start + "element vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
                 "no triangles");
    expect_error("a.ply", start + "element nothing 18446744073709551615\nend_header\n", "no triangles");  // at once
}

TEST_F(HostileMesh, APlyWithMissingDataIsRefused) {
    const std::string start = "ply\nformat binary_little_endian 1.0\n";
    const std::string points = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string nine(36, '\0');
    expect_error("a.ply",
                 start + points + "element face 4000000000\nproperty list uint int vertex_indices\nend_header\n" + nine,
                 "ends early");
    expect_error("a.ply",
                 start + points + "element face 1\nproperty list uint int vertex_indices\nend_header\n" + nine +
                     "\xff\xff\xff\xff",
                 "a list with a length of 4294967295");
    expect_error("a.ply", start + "element vertex -1\nproperty float x\nend_header\n", "an element without a count");
    expect_error("a.ply", start + "element vertex 99999999999999999999\nproperty float x\nend_header\n",
                 "an element without a count");
    std::string header = start;
    for (int i = 0; i < 10'000; ++i) header += "property int x\nelement a 0\n";
    expect_error("a.ply", start + "element a 0\n" + header + "end_header\n", "a header of more than 64 KiB");
}

TEST_F(HostileMesh, Stl) {
    expect_error("a.stl", "solid x\nendsolid x\n", "no triangles");
    expect_error("a.stl", "x", "no STL file");
    expect_error("a.stl", std::string(84, '\xff'),
                 "a binary one of 4294967295 facets would have 214748364834 bytes (it has 84)");
    expect_error("a.stl", std::string(80, ' ') + std::string(4, '\0'), "no triangles");
    expect_error("a.stl",
                 "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex a b c\n" + std::string(5000, 'y'),
                 "not a number, in line 5");
    expect_error("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid x\n",
                 "a facet of 1 corners");
}

// A maximum of three numbers may pass over one that is not a number: each place counts.
TEST_F(HostileMesh, CoordinatesThatAreNotNumbers) {
    for (std::size_t place = 0; place < 9; ++place)
        for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(),
                                  std::numeric_limits<float>::infinity(), 2e30f}) {
            std::array<float, 12> facet{0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};  // normal, then three corners
            facet[3 + place] = wrong;
            std::string bytes(80, ' ');
            bytes += std::string("\1\0\0\0", 4) +
                     std::string(reinterpret_cast<const char*>(facet.data()), sizeof facet) + std::string(2, '\0');
            expect_error("a.stl", bytes, "holds a coordinate that is not a finite number");
        }
}

TEST_F(HostileMesh, FilesThatEndAnywhereOrHaveBytesChanged) {
    // The result is a mesh or an error, without output to the terminal.
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    std::mt19937 random(1);
    std::size_t errors = 0, meshes = 0;
    for (const char* name : {"gem.obj", "t_handle.obj", "star.glb", "half_pipe.stl", "knot.ply"}) {
        std::ifstream file(asset(name), std::ios::binary);
        const std::string whole(std::istreambuf_iterator<char>(file), {});
        for (int i = 0; i < 40; ++i) {
            std::string text = whole;
            if (i % 2)
                text.resize(random() % text.size());
            else
                for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random());
            (error_of(write(fmt::format("{}{}", i, name), text)) == "no error" ? meshes : errors)++;
        }
    }
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_GT(errors, 50u);
    EXPECT_GT(meshes, 5u);
}

}  // namespace
}  // namespace tumble::hostile_mesh_test
