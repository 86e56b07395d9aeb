// Results of valid mesh files: surfaces welded, closed and oriented outward, with plausible normals.
#include "scene/mesh/mesh_loader.h"
#include "mesh_files.h"
#include "scene/mesh/mesh_faces.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

namespace tumble::mesh_loader_test {
namespace {

class MeshLoader : public MeshFiles {};

/// Drawn triangles match the surface, their normals are unit and on the side of their face.
void expect_drawable(const MeshAsset& mesh) {
    ASSERT_EQ(mesh.indices.size(), 3 * mesh.mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        ASSERT_LT(mesh.indices[i], mesh.vertices.size());
        const auto& t = mesh.mesh.triangles[i / 3];
        const MeshAsset::Vertex& drawn = mesh.vertices[mesh.indices[i]];
        const Vec3 p(drawn.position[0], drawn.position[1], drawn.position[2]),
            n(drawn.normal[0], drawn.normal[1], drawn.normal[2]);
        EXPECT_TRUE(p.isApprox(mesh.mesh.vertices[t[i % 3]], 1e-6) || (p - mesh.mesh.vertices[t[i % 3]]).norm() < 1e-6);
        EXPECT_NEAR(n.norm(), 1.0, 1e-6);
        const Vec3 &a = mesh.mesh.vertices[t[0]], &b = mesh.mesh.vertices[t[1]], &c = mesh.mesh.vertices[t[2]];
        EXPECT_GT((b - a).cross(c - a).dot(n), 0.0);
    }
}

TEST_F(MeshLoader, EveryMeshOfTheAssetsIsClosedAndFacesOutward) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(asset("."))) {
        for (const LoadedMesh& mesh : load_mesh_objects(entry.path())) {
            EXPECT_TRUE(mesh.closedness.closed()) << entry.path();
            EXPECT_GT(mesh.closedness.signed_volume, 0.0) << entry.path();
            expect_drawable(*mesh.asset);
        }
        EXPECT_LT(std::filesystem::file_size(entry.path()), 300'000u) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 10u);
}

TEST_F(MeshLoader, ReadsEachKindOfFile) {
    EXPECT_EQ(load_mesh(asset("torus.obj")).asset->mesh.triangles.size(), 2304u);
    EXPECT_EQ(load_mesh(asset("half_pipe.stl")).asset->mesh.triangles.size(), 212u);
    EXPECT_EQ(load_mesh(asset("knot.ply")).asset->mesh.triangles.size(), 4032u);
    EXPECT_EQ(load_mesh(asset("egg.gltf")).asset->mesh.triangles.size(), 2976u);
    EXPECT_EQ(load_mesh(asset("star.glb")).asset->mesh.vertices.size(), 12u);  // welded from 60 corners
}

TEST_F(MeshLoader, ATorusHasItsVolumeAndTheNormalsOfItsFile) {
    const LoadedMesh torus = load_mesh(asset("torus.obj"));
    EXPECT_NEAR(torus.closedness.signed_volume / (2.0 * M_PI * M_PI * 0.35 * 0.15 * 0.15), 1.0, 0.02);
    for (const MeshAsset::Vertex& v : torus.asset->vertices) {
        const double ring = std::hypot(v.position[0], v.position[2]);
        EXPECT_NEAR(v.normal[1], v.position[1] / 0.15, 1e-5);
        EXPECT_NEAR(v.normal[0], (ring - 0.35) / 0.15 * v.position[0] / ring, 1e-5);
    }
}

TEST_F(MeshLoader, TheCradlesTrackIsWhereTheBallsSlide) {
    const TriangleMesh track = load_mesh(asset("cradle_track.obj")).asset->mesh;
    int upper = 0;
    for (const Vec3& v : track.vertices) {
        EXPECT_NEAR(std::fabs(v.z()), 0.5, 1e-12);
        const double x = std::fabs(v.x()) - 1.0, radius = std::hypot(x, v.y() - 2.5);
        EXPECT_GE(x, -1e-9);  // the floor is one flat face
        EXPECT_NEAR(radius, radius < 2.78 ? 2.75 : 2.81, 1e-6);
        if (radius < 2.78) ++upper;
        EXPECT_LE(std::atan2(x, 2.5 - v.y()), M_PI / 3.0 + 1e-6);
    }
    EXPECT_EQ(upper, 2 * 2 * 241);
    EXPECT_NEAR(track.bounds().max.x(), 1.0 + 2.81 * std::sin(M_PI / 3.0), 1e-6);
}

TEST_F(MeshLoader, ACubeIsExactAndHasHardEdges) {
    const LoadedMesh cube = load_mesh(write("cube.obj", cube_points() + cube_faces()));
    EXPECT_EQ(cube.asset->mesh.vertices.size(), 8u);
    EXPECT_EQ(cube.asset->mesh.triangles.size(), 12u);
    EXPECT_DOUBLE_EQ(cube.closedness.signed_volume, 8.0);
    EXPECT_EQ(cube.asset->vertices.size(), 24u);  // three normals per corner
    expect_drawable(*cube.asset);
}

TEST_F(MeshLoader, DecimalsOfTheFileAreKeptExactly) {  // through assimp's floats
    const auto mesh = load_mesh(write("a.obj", "v 0.1 0.2 0.3\nv 12.3456 0 0\nv 0 -0.0007 0\nf 1 2 3\n"));
    EXPECT_EQ(mesh.asset->mesh.vertices[0], Vec3(0.1, 0.2, 0.3));
    EXPECT_EQ(mesh.asset->mesh.vertices[1], Vec3(12.3456, 0, 0));
    EXPECT_EQ(mesh.asset->mesh.vertices[2], Vec3(0, -0.0007, 0));
}

TEST_F(MeshLoader, ARoundSurfaceWithoutNormalsIsSmooth) {
    const auto knot = load_mesh(asset("knot.ply"));
    EXPECT_EQ(knot.asset->vertices.size(), knot.asset->mesh.vertices.size());  // one normal per point
    const auto egg = load_mesh(asset("egg.gltf"));
    EXPECT_EQ(egg.asset->vertices.size(), egg.asset->mesh.vertices.size());
    for (const MeshAsset::Vertex& v : egg.asset->vertices) {
        if (std::fabs(std::fabs(v.position[1]) - 0.5) > 1e-6) continue;
        EXPECT_NEAR(std::fabs(v.normal[1]), 1.0, 1e-5);  // at the poles
    }
}

TEST_F(MeshLoader, AGemKeepsItsFlatFacets) {
    const auto gem = load_mesh(asset("gem.obj"));
    const TriangleMesh& s = gem.asset->mesh;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        const Vec3 &a = s.vertices[s.triangles[t][0]], &b = s.vertices[s.triangles[t][1]],
                   &c = s.vertices[s.triangles[t][2]];
        const Vec3 face = (b - a).cross(c - a).normalized();
        for (int i = 0; i < 3; ++i) {
            const float* n = gem.asset->vertices[gem.asset->indices[3 * t + i]].normal;
            EXPECT_GT(face.dot(Vec3(n[0], n[1], n[2])), 0.99999);
        }
    }
}

TEST_F(MeshLoader, StlFacetsOfARoundTubeAreSmoothed) {
    std::string stl = "solid tube\n";
    const auto corner = [](int k, double z) {
        const double a = k * M_PI / 12.0;  // 24 sides: 15 degrees per edge
        return fmt::format("vertex {:.6f} {:.6f} {}\n", std::cos(a), std::sin(a), z);
    };
    for (int k = 0; k < 24; ++k) {
        const int n = (k + 1) % 24;
        stl += "facet normal 0 0 0\nouter loop\n" + corner(k, 0) + corner(n, 0) + corner(n, 1) + "endloop\nendfacet\n";
        stl += "facet normal 0 0 0\nouter loop\n" + corner(k, 0) + corner(n, 1) + corner(k, 1) + "endloop\nendfacet\n";
    }
    const auto tube = load_mesh(write("tube.stl", stl + "endsolid tube\n"));
    EXPECT_EQ(tube.asset->mesh.vertices.size(), 48u);
    EXPECT_EQ(tube.asset->vertices.size(), 48u);
    EXPECT_EQ(tube.closedness.open_edges, 48u);
    for (const MeshAsset::Vertex& v : tube.asset->vertices) {
        EXPECT_NEAR(v.position[0] * v.normal[0] + v.position[1] * v.normal[1], 1.0, 1e-3);
    }
}

TEST_F(MeshLoader, AnInsideOutMeshIsTurned) {
    const auto mesh =
        load_mesh(write("a.obj", cube_points() + "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n"));
    EXPECT_TRUE(mesh.closedness.closed());
    EXPECT_DOUBLE_EQ(mesh.closedness.signed_volume, 8.0);
    EXPECT_DOUBLE_EQ(closedness(mesh.asset->mesh).signed_volume, 8.0);
    expect_drawable(*mesh.asset);
}

// Any subset of a cube's faces is wound the other way (all: consistent), beside a small correct tetrahedron.
TEST_F(MeshLoader, FacesThatDisagreeAreTurned) {
    const std::array<std::string, 6> outward = {"1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"};
    const std::array<std::string, 6> inward = {"2 3 4 1", "8 7 6 5", "5 6 2 1", "6 7 3 2", "7 8 4 3", "8 5 1 4"};
    for (unsigned which = 0; which < 63; ++which) {
        std::string text =
            cube_points() + "v 9 0 0\nv 10 0 0\nv 9 1 0\nv 9 0 1\nf 9 11 10\nf 9 10 12\nf 9 12 11\nf 10 11 12\n";
        for (unsigned face = 0; face < 6; ++face) text += "f " + (which >> face & 1 ? inward : outward)[face] + "\n";
        const auto mesh = load_mesh(write("a.obj", text));
        EXPECT_TRUE(mesh.closedness.closed()) << which;
        EXPECT_NEAR(mesh.closedness.signed_volume, 8.0 + 1.0 / 6.0, 1e-12) << which;
        expect_drawable(*mesh.asset);
    }
}

// The larger part of an open component decides.
TEST_F(MeshLoader, OpenComponentsAreTurnedLikeMostOfTheirArea) {
    const std::string strip = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 3 0 0\nv 3 1 0\n";
    for (const auto& [faces, up] :
         {std::pair{"f 1 2 3 4\nf 2 5 6 3\nf 8 7 5 6\n", 1.0}, std::pair{"f 1 2 3 4\nf 3 6 5 2\nf 6 8 7 5\n", -1.0}}) {
        const auto mesh = load_mesh(write("strip.obj", strip + faces));
        EXPECT_EQ(mesh.closedness.crowded_edges, 0u) << faces;
        EXPECT_EQ(mesh.closedness.open_edges, 8u) << faces;
        for (const MeshAsset::Vertex& v : mesh.asset->vertices) EXPECT_EQ(v.normal[2], up) << faces;
    }
}

TEST_F(MeshLoader, AOneSidedSurfaceIsUnchanged) {
    std::string strip;  // a Moebius strip of 12 quads
    for (int k = 0; k < 12; ++k) {
        const double a = k * M_PI / 6.0, half = 0.5 * a;
        for (const double side : {-0.3, 0.3}) {
            const double r = 1.0 + side * std::cos(half);
            strip += fmt::format("v {} {} {}\n", r * std::cos(a), r * std::sin(a), side * std::sin(half));
        }
    }
    for (int k = 0; k < 11; ++k) strip += fmt::format("f {} {} {} {}\n", 2 * k + 1, 2 * k + 3, 2 * k + 4, 2 * k + 2);
    const auto mesh = load_mesh(write("strip.obj", strip + "f 23 2 1 24\n"));
    EXPECT_EQ(mesh.closedness.crowded_edges, 1u);
    EXPECT_EQ(mesh.asset->mesh.triangles.size(), 24u);
}

TEST_F(MeshLoader, AnOpenMeshSaysHowManyEdgesAreOpen) {
    const auto mesh =
        load_mesh(write("a.obj", cube_points() + "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"));
    EXPECT_EQ(mesh.closedness.open_edges, 4u);
    EXPECT_FALSE(mesh.closedness.closed());
}

TEST_F(MeshLoader, PointsThatNoFaceUsesAndFacesWithoutAreaAreLeftOut) {
    const auto mesh =
        load_mesh(write("a.obj", "v 99 99 99\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.5 0 0\nf 2 3 4\nf 2 5 3\nf 2 2 3\n"));
    EXPECT_EQ(mesh.asset->mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.asset->mesh.vertices.size(), 3u);
    EXPECT_EQ(mesh.asset->mesh.bounds().max, Vec3(1, 1, 0));
}

TEST_F(MeshLoader, ASliverThatClosesAGapCountsForClosedness) {
    // The cube with a point at the center of edge 1-2, which one of its faces uses; the sliver 1, 2, 9 closes the gap.
    const auto mesh = load_mesh(write("a.obj", cube_points() + "v 0 -1 -1\nf 1 4 3 2\nf 5 6 7 8\nf 1 9 2 6 5\nf 1 2 9\n"
                                                               "f 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"));
    EXPECT_TRUE(mesh.closedness.closed());
    EXPECT_DOUBLE_EQ(mesh.closedness.signed_volume, 8.0);
    for (const auto& t : mesh.asset->mesh.triangles) {
        const auto& v = mesh.asset->mesh.vertices;
        EXPECT_GT((v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm(), 0.1);
    }
}

TEST_F(MeshLoader, NodesOfAGltfMoveTurnAndMirrorTheirMeshes) {
    std::string text;
    {
        std::ifstream file(asset("egg.gltf"));
        text.assign(std::istreambuf_iterator<char>(file), {});
    }
    const auto replace = [&](const std::string& matrix) {
        std::string changed = text;
        const std::string node = "\"nodes\": [\n  {";
        const std::size_t at = changed.find(node);
        EXPECT_NE(at, std::string::npos);
        return changed.insert(at + node.size(), "\"matrix\": [" + matrix + "],");
    };
    const auto egg = load_mesh(asset("egg.gltf"));
    const auto moved = load_mesh(write("moved.gltf", replace("2,0,0,0, 0,2,0,0, 0,0,2,0, 10,20,30,1")));
    EXPECT_TRUE(moved.asset->mesh.bounds().center().isApprox(Vec3(10, 20, 30), 1e-6));
    EXPECT_NEAR(moved.closedness.signed_volume, 8.0 * egg.closedness.signed_volume, 1e-6);
    const auto mirrored = load_mesh(write("mirrored.gltf", replace("1,0,0,0, 0,-1,0,0, 0,0,1,0, 0,0,0,1")));
    EXPECT_NEAR(mirrored.closedness.signed_volume, egg.closedness.signed_volume, 1e-9);
    expect_drawable(*mirrored.asset);
}

TEST_F(MeshLoader, AMirroredSheetKeepsItsFrontSide) {
    // One triangle in x and y, seen from +z; mirrored in y its corners are in reverse order, and its face is oriented
    // as before.
    const auto sheet = [](const char* scale) {
        return fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
            "nodes":[{{"mesh":0,"scale":{}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":
            "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}})",
                           scale);
    };
    for (const char* scale : {"[1,1,1]", "[1,-1,1]", "[-1,1,1]"}) {
        const auto mesh = load_mesh(write("sheet.gltf", sheet(scale)));
        ASSERT_EQ(mesh.asset->mesh.triangles.size(), 1u);
        EXPECT_TRUE(face_normal(mesh.asset->mesh, 0).isApprox(Vec3(0, 0, 1))) << scale;
    }
}

TEST_F(MeshLoader, PlyInItsThreeEncodingsIsTheSame) {
    const std::string header =
        " 1.0\ncomment x\nelement vertex 4\nproperty double x\nproperty float y\nproperty short z\n"
        "property uchar red\nelement face 4\nproperty list uchar int vertex_index\nend_header\n";
    const std::string text =
        "ply\nformat ascii" + header + "0 0 0 9\n1 0 0 9\n0 0.1 0 9\n0 0 1 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    const auto binary = [&](bool big) {
        std::string data;
        const auto put = [&](auto value) {
            std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
            if (big) std::reverse(bytes.begin(), bytes.end());
            data += bytes;
        };
        const double x[] = {0, 1, 0, 0};
        const float y[] = {0, 0, 0.1f, 0};
        const std::int16_t z[] = {0, 0, 0, 1};
        for (int i = 0; i < 4; ++i) put(x[i]), put(y[i]), put(z[i]), put(std::uint8_t(9));
        for (const auto& f : {std::array<int, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
            put(std::uint8_t(3));
            for (const int i : f) put(std::int32_t(i));
        }
        return std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian" + header + data;
    };
    const auto a = load_mesh(write("a.ply", text)), b = load_mesh(write("b.ply", binary(false))),
               c = load_mesh(write("c.ply", binary(true)));
    for (const LoadedMesh& mesh : {a, b, c}) {
        EXPECT_TRUE(mesh.closedness.closed());
        EXPECT_DOUBLE_EQ(mesh.closedness.signed_volume, 0.1 / 6.0);
        EXPECT_EQ(mesh.asset->mesh.vertices[2], Vec3(0, 0.1, 0));
    }
}

TEST_F(MeshLoader, WeldsVerticesCloserThanABillionthOfTheSize) {
    const auto same = weld({{0, 0, 0}, {1, 0, 0}, {1, 5e-10, 0}, {1, 5e-9, 0}, {0, 0, 0}, {0, 0, 1}});
    EXPECT_EQ(same, (std::vector<std::uint32_t>{0, 1, 1, 3, 0, 5}));
    EXPECT_EQ(weld({{3, 3, 3}, {3, 3, 3}}), (std::vector<std::uint32_t>{0, 0}));
    EXPECT_TRUE(weld({}).empty());
}

TEST_F(MeshLoader, TheCacheSharesEqualScales) {
    MeshCache cache;
    const auto one = cache.load(asset("gem.obj"), 1.0).asset, again = cache.load(asset("gem.obj"), 1.0).asset;
    const auto two = cache.load(asset("gem.obj"), 2.0).asset;
    EXPECT_EQ(one, again);
    EXPECT_NE(one, two);
    EXPECT_EQ(two, cache.load(asset("gem.obj"), 2.0).asset);
    EXPECT_TRUE(two->mesh.bounds().max.isApprox(2.0 * one->mesh.bounds().max));
    EXPECT_NEAR(cache.load(asset("gem.obj"), 2.0).closedness.signed_volume,
                8.0 * cache.load(asset("gem.obj"), 1.0).closedness.signed_volume, 1e-12);
}

// The cube of 8 m^3 in files as programs write them, each against the letter of its format.
TEST_F(MeshLoader, ReadsFilesAsProgramsWriteThem) {
    const auto volume = [&](const std::string& name, const std::string& text) {
        const LoadedMesh mesh = load_mesh(write(name, text));
        EXPECT_TRUE(mesh.closedness.closed()) << name;
        return mesh.closedness.signed_volume;
    };
    const std::string cube = cube_points() + cube_faces();
    EXPECT_DOUBLE_EQ(volume("mark.obj", "\xef\xbb\xbf" + cube), 8.0);
    std::string little = "\xff\xfe", big = "\xfe\xff";
    for (const char c : cube) {
        little += {c, '\0'};
        big += {'\0', c};
    }
    EXPECT_DOUBLE_EQ(volume("little.obj", little), 8.0);
    EXPECT_DOUBLE_EQ(volume("big.obj", big), 8.0);
    std::string named = cube_faces();  // normals that the file does not hold
    for (std::size_t at = 0; (at = named.find_first_of("12345678", at)) != named.npos; at += 4)
        named.insert(at + 1, "//1");
    EXPECT_DOUBLE_EQ(volume("normals.obj", cube_points() + named), 8.0);
    EXPECT_DOUBLE_EQ(volume("curve.obj", cube_points() + "cstype bezier\n" + cube_faces()), 8.0);

    std::string facets;
    const LoadedMesh solid = load_mesh(write("cube.obj", cube));
    for (const auto& t : solid.asset->mesh.triangles) {
        facets += "FACET NORMAL 0 0 0\nOUTER LOOP\n";
        for (const std::uint32_t v : t) {
            const Vec3& p = solid.asset->mesh.vertices[v];
            facets += fmt::format("VERTEX {} {} {}\n", p.x(), p.y(), p.z());
        }
        facets += "ENDLOOP\nENDFACET\n";
    }
    EXPECT_DOUBLE_EQ(volume("capitals.stl", "SOLID CUBE\n" + facets + "ENDSOLID CUBE\n"), 8.0);
    std::string binary(80, ' ');
    const auto put = [&](const auto& value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(std::uint32_t(solid.asset->mesh.triangles.size()));
    for (const auto& t : solid.asset->mesh.triangles) {
        for (int i = 0; i < 3; ++i) put(0.0f);
        for (const std::uint32_t v : t)
            for (int i = 0; i < 3; ++i) put(float(solid.asset->mesh.vertices[v][i]));
        put(std::uint16_t(0));
    }
    EXPECT_DOUBLE_EQ(volume("more.stl", binary + "made by a program"), 8.0);

    const std::string vertices = "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
    std::string rows;
    for (std::size_t i = 0; i < 8; ++i)
        rows += fmt::format("{} {} {} 0.5 7\n", i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    EXPECT_DOUBLE_EQ(
        volume("columns.ply", "ply\nformat ascii 1.0\n" + vertices +
                                  "element face 6\nproperty list uchar int vertex_indices\nend_header\n" + rows +
                                  "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n"),
        8.0);
    EXPECT_DOUBLE_EQ(
        volume("strips.ply", "ply\nformat ascii 1.0\n" + vertices +
                                 "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + rows +
                                 "20 3 2 1 0 5 4 7 6 3 2 -1 0 2 4 6 -1 1 5 3 7\n"),
        8.0);
}

// A file may be a library without scenes: its nodes that are no child are drawn.
TEST_F(MeshLoader, AGltfWithoutScenesHasItsRoots) {
    std::ifstream file(asset("egg.gltf"));
    std::string text((std::istreambuf_iterator<char>(file)), {});
    nlohmann::json document = nlohmann::json::parse(text);
    document.erase("scenes");
    document.erase("scene");
    const LoadedMesh mesh = load_mesh(write("egg.gltf", document.dump()));
    EXPECT_EQ(mesh.asset->mesh.triangles.size(), load_mesh(asset("egg.gltf")).asset->mesh.triangles.size());
}

}  // namespace
}  // namespace tumble::mesh_loader_test
