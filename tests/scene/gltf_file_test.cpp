// glTF files: supported content, errors, and the other files that they may open.
#include "mesh_files.h"
#include "support/tiny_png.h"

#include "scene/mesh/mesh_loader.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <fmt/format.h>
#include <meshoptimizer.h>
#include <sys/stat.h>

#include <unistd.h>
#include <cstring>
#include <vector>

namespace tumble::gltf_file_test {
namespace {

template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// A tetrahedron: positions, then indices.
const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
const std::vector<std::uint16_t> faces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
std::string tetrahedron() { return bytes_of(corners) + bytes_of(faces); }

/// The parts of a document with one mesh; a test replaces the parts under test.
struct Document {
    std::string nodes = R"([{"mesh":0}])", roots = "[0]";
    std::string primitives = R"([{"attributes":{"POSITION":0},"indices":1}])";
    std::string accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                                {"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}])";
    std::string views = R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}])";
    std::string buffers = R"([{"byteLength":72,"uri":"data.bin"}])";
    std::string more;

    std::string text() const {
        return fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":{}}}],"nodes":{},"meshes":[{{"primitives":{}}}],
"accessors":{},"bufferViews":{},"buffers":{}{}}})",
            roots, nodes, primitives, accessors, views, buffers, more);
    }
};

std::string glb(const std::string& json, const std::string& binary) {
    const auto number = [](std::size_t value) { return bytes_of(std::vector<std::uint32_t>{std::uint32_t(value)}); };
    const std::string body =
        number(json.size()) + "JSON" + json + number(binary.size()) + std::string("BIN\0", 4) + binary;
    return "glTF" + number(2) + number(12 + body.size()) + body;
}

class Gltf : public MeshFiles {
protected:
    Gltf() { write("data.bin", tetrahedron()); }

    LoadedMesh loaded(const Document& document) const { return load_mesh(write("a.gltf", document.text())); }
    std::string error_of(const std::string& text, const std::string& name = "a.gltf") const {
        try {
            load_mesh(write(name, text));
        } catch (const MeshError& error) {
            return error.what();
        }
        return "no error";
    }
    std::string error_of(const Document& document) const { return error_of(document.text()); }
    std::string error_with_uri(const std::string& uri) const {
        Document document;
        document.buffers = R"([{"byteLength":72,"uri":")" + uri + "\"}]";
        return error_of(document);
    }
    void expect_tetrahedron(const LoadedMesh& mesh) const {
        EXPECT_EQ(mesh.asset->mesh.vertices.size(), 4u);
        EXPECT_DOUBLE_EQ(mesh.closedness.signed_volume, 1.0 / 6.0);
        EXPECT_TRUE(mesh.closedness.closed());
    }
};

TEST_F(Gltf, BuffersAreFilesOfTheFolderDataUrisOrTheBinaryChunk) {
    expect_tetrahedron(loaded({}));
    std::filesystem::create_directory(folder() / "deep");
    std::filesystem::create_symlink("../data.bin", folder() / "deep" / "link.bin");
    write("my data.bin", tetrahedron());
    for (const char* uri : {"deep/link.bin", "./deep/../data.bin", "my%20data.bin", "my data.bin"})
        EXPECT_EQ(error_with_uri(uri), "no error") << uri;

    Document two;  // one buffer each for positions and indices
    two.views = R"([{"buffer":0,"byteLength":48},{"buffer":1,"byteLength":24}])";
    two.buffers =
        R"([{"byteLength":48,"uri":"data.bin"},{"byteLength":24,"uri":"data:application/gltf-buffer;base64,AAACAAEAAAABAAMAAAADAAIAAQACAAMA"}])";
    expect_tetrahedron(loaded(two));

    Document chunk;
    chunk.buffers = R"([{"byteLength":72}])";
    expect_tetrahedron(load_mesh(write("a.glb", glb(chunk.text(), tetrahedron()))));
    expect_tetrahedron(load_mesh(write("a.glb", glb(Document{}.text(), ""))));
}

TEST_F(Gltf, NodesThatShowOneMeshAreEachAnObject) {
    Document document;
    document.nodes =
        R"([{"children":[1,2]},{"mesh":0,"translation":[2,0,0]},{"mesh":0,"rotation":[0,1,0,0],"scale":[1,2,-1]}])";
    EXPECT_EQ(loaded(document).asset->mesh.triangles.size(), 8u);
    const auto objects = load_mesh_objects(folder() / "a.gltf");
    ASSERT_EQ(objects.size(), 2u);
    EXPECT_EQ(objects[0].asset->mesh.bounds().min, Vec3(2, 0, 0));
    EXPECT_EQ(objects[1].asset->mesh.bounds().min, Vec3(-1, 0, 0));
    EXPECT_EQ(objects[1].asset->mesh.bounds().max, Vec3(0, 2, 1));
    EXPECT_DOUBLE_EQ(objects[1].closedness.signed_volume, 2.0 / 6.0);
}

TEST_F(Gltf, StripsFansAndUnindexedTriangles) {
    write("data.bin", bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) +
                          bytes_of(std::vector<std::uint16_t>{0, 1, 3, 2}));
    const auto area = [&](const std::string& primitive) {
        Document document;
        document.primitives = "[" + primitive + "]";
        document.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                                 {"bufferView":1,"componentType":5123,"count":4,"type":"SCALAR"}])";
        document.views = R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":8}])";
        document.buffers = R"([{"byteLength":56,"uri":"data.bin"}])";
        const auto mesh = loaded(document);
        Vec3 sum = Vec3::Zero();
        for (const auto& t : mesh.asset->mesh.triangles) {
            const Vec3& a = mesh.asset->mesh.vertices[t[0]];
            sum += 0.5 * (mesh.asset->mesh.vertices[t[1]] - a).cross(mesh.asset->mesh.vertices[t[2]] - a);
        }
        return sum;
    };
    EXPECT_EQ(area(R"({"attributes":{"POSITION":0},"mode":5})"), Vec3(0, 0, 1));              // a strip
    EXPECT_EQ(area(R"({"attributes":{"POSITION":0},"indices":1,"mode":6})"), Vec3(0, 0, 1));  // a fan
    EXPECT_EQ(area(R"({"attributes":{"POSITION":0}})"), Vec3(0, 0, 0.5));  // the fourth is incomplete
    EXPECT_EQ(area(R"({"attributes":{"POSITION":0},"mode":1},{"attributes":{"POSITION":0}})"),
              Vec3(0, 0, 0.5));  // lines
}

TEST_F(Gltf, SparseAccessorsChangeSomeElementsOfABufferOrOfZeros) {
    write("sparse.bin", bytes_of(std::vector<std::uint8_t>{1, 3, 0, 0}) +
                            bytes_of(std::vector<float>{2, 0, 0, 0, 0, 3}) +
                            bytes_of(std::vector<std::uint8_t>{1, 2, 3, 0}) +
                            bytes_of(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    Document document;
    document.views =
        R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24},{"buffer":1,"byteLength":68}])";
    document.buffers = R"([{"byteLength":72,"uri":"data.bin"},{"byteLength":68,"uri":"sparse.bin"}])";
    const std::string indices = R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}])";
    document.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,
        "indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":2,"byteOffset":4}}},)" +
                         indices;
    EXPECT_DOUBLE_EQ(loaded(document).closedness.signed_volume, 2.0 * 3.0 / 6.0);
    document.accessors = R"([{"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":3,
        "indices":{"bufferView":2,"byteOffset":28,"componentType":5121},"values":{"bufferView":2,"byteOffset":32}}},)" +
                         indices;
    expect_tetrahedron(loaded(document));
}

TEST_F(Gltf, WholeNumbersWithAStrideAreCoordinates) {  // KHR_mesh_quantization
    std::vector<std::int16_t> numbers;
    for (std::size_t i = 0; i < 12; ++i) {
        numbers.push_back(std::int16_t(corners[i] * 32767));
        if (i % 3 == 2) numbers.push_back(-1);  // padding
    }
    write("data.bin", bytes_of(numbers) + bytes_of(faces));
    Document document;
    document.accessors = R"([{"bufferView":0,"componentType":5122,"normalized":true,"count":4,"type":"VEC3"},
                             {"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}])";
    document.views = R"([{"buffer":0,"byteLength":32,"byteStride":8},{"buffer":0,"byteOffset":32,"byteLength":24}])";
    document.buffers = R"([{"byteLength":56,"uri":"data.bin"}])";
    document.more = R"(,"extensionsRequired":["KHR_mesh_quantization","KHR_materials_unlit"])";
    expect_tetrahedron(loaded(document));
}

TEST_F(Gltf, OtherFilesAreRegularOnesOfItsFolder) {
    const TestFolder outside;
    write_text(outside / "secret.bin", tetrahedron());
    std::filesystem::create_symlink(outside / "secret.bin", folder() / "out.bin");
    std::filesystem::create_directory_symlink(outside.path(), folder() / "out");
    std::filesystem::create_directory(folder() / "deep");
    ASSERT_EQ(mkfifo((folder() / "fifo.bin").c_str(), 0600), 0);
    const std::string neighbour = "../" + outside.path().filename().string() + "/secret.bin";
    for (const std::string& uri :
         {neighbour, std::string("out.bin"), std::string("out/secret.bin"), "deep/../" + neighbour})
        EXPECT_NE(error_with_uri(uri).find("which lies outside its folder"), std::string::npos) << error_with_uri(uri);
    for (const std::string& uri :
         {(outside / "secret.bin").string(), std::string("/etc/passwd"), std::string("/dev/zero"), std::string(),
          std::string("data.bin\\u0000x"), std::string("data.bin%00x")})
        EXPECT_NE(error_with_uri(uri).find("which is not a file of its folder"), std::string::npos)
            << error_with_uri(uri);
    EXPECT_NE(error_with_uri("fifo.bin").find("which is not a regular file"), std::string::npos);
    for (const char* uri : {"deep", "."})
        EXPECT_NE(error_with_uri(uri).find("which is a folder, not a file"), std::string::npos) << error_with_uri(uri);
    EXPECT_NE(error_with_uri("none.bin").find("\"none.bin\", which does not exist"), std::string::npos);
    EXPECT_NE(error_with_uri("http://localhost/data.bin").find("which does not exist"), std::string::npos);
    EXPECT_NE(error_with_uri("\\u001b[2J" + std::string(100'000, 'x')).find("\"?[2Jxxx"), std::string::npos);
    EXPECT_LT(error_with_uri(std::string(100'000, 'x')).size(), 200u);
}

TEST_F(Gltf, ImagesAndBuffersOfAnimationsAreNotOpened) {
    ASSERT_EQ(mkfifo((folder() / "fifo.bin").c_str(), 0600), 0);
    Document document;
    document.buffers = R"([{"byteLength":72,"uri":"data.bin"},{"byteLength":72,"uri":"fifo.bin"}])";
    document.more = R"(,"images":[{"uri":"fifo.bin"},{"uri":"/etc/passwd"}],"materials":[{}])";
    expect_tetrahedron(loaded(document));
}

TEST_F(Gltf, CountsAreCheckedBeforeAnythingIsMade) {
    const std::string indices = R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}])";
    Document document;
    document.accessors = R"([{"componentType":5126,"count":100000000,"type":"VEC3","sparse":{"count":1,
        "indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":0}}},)" +
                         indices;
    EXPECT_NE(error_of(document).find("an accessor of 100000000 elements in"), std::string::npos) << error_of(document);
    document.accessors = R"([{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"},)" + indices;
    EXPECT_EQ(error_of(document), "has an accessor of 5 elements beyond its buffer view");
    for (const char* count : {"18446744073709551615", "6148914691236517206", "4294967297", "-1", "4.5", "\"4\""}) {
        document.accessors =
            fmt::format(R"([{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)", count) + indices;
        EXPECT_EQ(error_of(document).substr(0, 4), "has ") << error_of(document);
    }
    document = {};
    for (const char* view : {R"({"buffer":0,"byteOffset":18446744073709551615,"byteLength":48})",
                             R"({"buffer":0,"byteLength":73})", R"({"buffer":0,"byteOffset":48,"byteLength":48})"}) {
        document.views = fmt::format(R"([{},{{"buffer":0,"byteOffset":48,"byteLength":24}}])", view);
        EXPECT_EQ(error_of(document), "has a buffer view beyond its buffer of 72 bytes");
    }
    document.views =
        R"([{"buffer":0,"byteLength":48,"byteStride":4294967295},{"buffer":0,"byteOffset":48,"byteLength":24}])";
    EXPECT_NE(error_of(document).find("\"byteStride\" of 4294967295"), std::string::npos);
    document = {};
    document.buffers = R"([{"byteLength":4000000000,"uri":"data.bin"}])";
    EXPECT_EQ(error_of(document), "has a buffer of 72 bytes of 4000000000");
    document = {};
    document.primitives = R"([{"attributes":{"POSITION":0},"indices":7}])";
    EXPECT_EQ(error_of(document), "names item 7 of \"accessors\", which holds 2");
    write("data.bin", bytes_of(corners) + std::string(24, '\x07'));
    EXPECT_EQ(error_of(Document{}), "has a face with vertex 1799 of 4");
}

TEST_F(Gltf, NodesAreAForest) {
    Document document;
    document.nodes = "[";
    for (int i = 1; i < 64; ++i)
        document.nodes += fmt::format(R"({{"children":[{},{}]}},)", i, i);  // twice as many per level
    document.nodes += R"({"mesh":0}])";
    EXPECT_EQ(error_of(document), "has node 1 twice in its tree of nodes");
    document.nodes = R"([{"mesh":0,"children":[1]},{"children":[0]}])";
    EXPECT_EQ(error_of(document), "has node 0 twice in its tree of nodes");
    document.nodes = R"([{"mesh":0}])";
    document.roots = "[0,0]";
    EXPECT_EQ(error_of(document), "has node 0 twice in its tree of nodes");
    document.roots = "[18446744073709551615]";
    EXPECT_EQ(error_of(document), "names item 18446744073709551615 of \"nodes\", which holds 1");
}

TEST_F(Gltf, DepthCostsNoStack) {
    Document document;  // 200,000 nodes, each the child of the one before
    document.nodes = "[";
    for (int i = 1; i < 200'000; ++i) document.nodes += fmt::format(R"({{"children":[{}]}},)", i);
    document.nodes += R"({"mesh":0}])";
    expect_tetrahedron(loaded(document));
    EXPECT_EQ(error_of(std::string(200'000, '[')), "is not JSON (a mistake at byte 200001 of 200000)");
    document = {};
    document.more = ",\"extras\":" + std::string(200'000, '[') + std::string(200'000, ']');
    expect_tetrahedron(loaded(document));
}

TEST_F(Gltf, ManyNodesOfOneMeshAreCountedBeforeTheyAreMade) {
    Document document;
    const auto strip = [&](std::size_t corner_count) {
        write("data.bin", bytes_of(corners) + std::string(corner_count, '\0'));
        document.accessors = fmt::format(R"([{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
                                             {{"bufferView":1,"componentType":5121,"count":{},"type":"SCALAR"}}])",
                                         corner_count);
        document.views = fmt::format(
            R"([{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":{}}}])", corner_count);
        document.buffers = fmt::format(R"([{{"byteLength":{},"uri":"data.bin"}}])", 48 + corner_count);
        document.primitives = R"([{"attributes":{"POSITION":0},"indices":1,"mode":5}])";
    };
    strip(5'000'003);
    EXPECT_EQ(error_of(document), "has more than 5000000 triangles");
    strip(500'002);
    document.nodes = R"([{"mesh":0})";
    document.roots = "[0";
    for (int i = 1; i <= 10; ++i) {
        document.nodes += R"(,{"mesh":0})";
        document.roots += fmt::format(",{}", i);
    }
    document.nodes += "]";
    document.roots += "]";
    EXPECT_EQ(error_of(document), "has more than 5000000 triangles");
}

TEST_F(Gltf, OtherFilesAndVersionsAreRefused) {
    EXPECT_EQ(error_of("{"), "is not JSON (a mistake at byte 2 of 1)");
    std::string zeros = "[0";
    for (int i = 0; i < 10'000'000; ++i) zeros += ",0";
    EXPECT_EQ(error_of(zeros + "]"), "holds more than 10000000 JSON values");
    EXPECT_EQ(error_of("{\"a\":1e999}"), "is JSON with a number beyond all range");
    EXPECT_EQ(error_of("[]"), "is no glTF file: it has no \"asset\" with a \"version\"");
    EXPECT_TRUE(error_of("{\"asset\":{\"version\":\"1.0\"}}").starts_with("is glTF 1, not 2.0 (assimp: "));
    EXPECT_EQ(error_of("{\"asset\":{\"version\":\"3.0\"}}"), "is glTF 3.0, not 2.0");
    EXPECT_EQ(error_of("{\"asset\":{\"version\":\"2.0\"}}"), "holds no triangles");
    Document document;
    document.primitives =
        R"([{"attributes":{"POSITION":0},"indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}])";
    EXPECT_TRUE(error_of(document).starts_with("has a mesh that Draco cannot read: "));
    document = {};
    document.more = R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])";
    EXPECT_EQ(error_of(document), "needs EXT_mesh_gpu_instancing, which cannot be read: export it without");
    document = {};
    document.buffers = R"([{"byteLength":3,"uri":"data:application/octet-stream;base64,AA$A"}])";
    EXPECT_EQ(error_of(document), "has a buffer with broken base64");
}

TEST_F(Gltf, BufferViewsThatMeshoptimizerCompressedAreTheSameMesh) {
    std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(4, 12)),
        triangles(meshopt_encodeIndexBufferBound(12, 4));
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), corners.data(), 4, 12));
    const std::vector<std::uint32_t> wide(faces.begin(), faces.end());
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), wide.data(), 12));
    write("packed.bin", bytes_of(vertices) + bytes_of(triangles));
    Document document;
    document.buffers = fmt::format(R"([{{"byteLength":{},"uri":"packed.bin"}},{{"byteLength":72}}])",
                                   vertices.size() + triangles.size());
    const auto views = [&](const char* mode, int count, const char* filter) {
        return fmt::format(
            R"([{{"buffer":1,"byteLength":48,"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteLength":{},"byteStride":12,"count":{},"mode":"{}"{}}}}}}},
{{"buffer":1,"byteOffset":48,"byteLength":24,"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteOffset":{},"byteLength":{},"byteStride":2,"count":12,"mode":"TRIANGLES"}}}}}}])",
            vertices.size(), count, mode, filter, vertices.size(), triangles.size());
    };
    document.more = R"(,"extensionsRequired":["EXT_meshopt_compression"])";
    document.views = views("ATTRIBUTES", 4, "");
    EXPECT_NEAR(loaded(document).closedness.signed_volume, 1.0 / 6.0, 1e-12);
    document.views = views("ATTRIBUTES", 400, "");
    EXPECT_TRUE(error_of(document).starts_with("has a compressed buffer view that meshoptimizer cannot read"));
    document.views = views("WORDS", 4, "");
    EXPECT_EQ(error_of(document), "has a compressed buffer view of mode \"WORDS\" with 4 times 12 bytes");
    document.views = views("ATTRIBUTES", 4, R"(,"filter":"OCTAHEDRAL")");
    EXPECT_EQ(error_of(document), "has a compressed buffer view with the filter \"OCTAHEDRAL\" on 12 bytes");
    document.views = views("ATTRIBUTES", 2'000'000'000, "");
    EXPECT_TRUE(error_of(document).starts_with("has a compressed buffer view of 2000000000 times 12 bytes"));
}

TEST_F(Gltf, AMeshThatDracoCompressedIsTheSameMesh) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(4);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (int t = 0; t < 4; ++t)
        builder.SetAttributeValuesForFace(
            position, draco::FaceIndex(std::uint32_t(t)), &corners[3u * faces[std::size_t(3 * t)]],
            &corners[3u * faces[std::size_t(3 * t + 1)]], &corners[3u * faces[std::size_t(3 * t + 2)]]);
    const auto mesh = builder.Finalize();
    draco::EncoderBuffer packed;
    ASSERT_TRUE(draco::Encoder().EncodeMeshToBuffer(*mesh, &packed).ok());
    write("draco.bin", std::string(packed.data(), packed.size()));
    Document document;
    document.buffers = fmt::format(R"([{{"byteLength":{},"uri":"draco.bin"}}])", packed.size());
    document.views = fmt::format(R"([{{"buffer":0,"byteLength":{}}}])", packed.size());
    document.accessors =
        R"([{"componentType":5126,"count":4,"type":"VEC3"},{"componentType":5123,"count":12,"type":"SCALAR"}])";
    document.primitives =
        R"([{"attributes":{"POSITION":0},"indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}])";
    document.more = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
    const LoadedMesh made = loaded(document);
    EXPECT_EQ(made.asset->indices.size(), 12u);
    EXPECT_NEAR(made.closedness.signed_volume, 1.0 / 6.0, 1e-12);
    document.views = R"([{"buffer":0,"byteLength":20}])";
    EXPECT_TRUE(error_of(document).starts_with("has a mesh that Draco cannot read: "));
}

TEST_F(Gltf, MaterialsHaveTheMapsOfTheirImages) {
    write("tiny.png", tiny_png());  // red, green; blue, white
    Document document;
    document.primitives = R"([{"attributes":{"POSITION":0,"TEXCOORD_0":0},"indices":1,"material":0}])";
    const auto material = [&](const std::string& emission) {
        document.more = R"(,"images":[{"uri":"tiny.png"}],"textures":[{"source":0}],"materials":[{
            "pbrMetallicRoughness":{"roughnessFactor":0.5,"metallicRoughnessTexture":{"index":0},
                                    "baseColorFactor":[1,1,1,0.25]},
            "normalTexture":{"index":0},"occlusionTexture":{"index":0,"strength":0.5},
            "emissiveFactor":[1,0.5,0],"alphaMode":"BLEND","emissiveTexture":)" +
                        emission + "}]";
        return loaded(document).asset->paint;
    };
    using Texel = std::array<std::uint8_t, 4>;
    const auto paint = material(R"({"index":0})");
    const MeshMaterial& one = paint->materials[0];
    EXPECT_EQ(one.maps.surface->levels[0].texels[0], (Texel{255, 0, 0, 255}));
    EXPECT_EQ(one.maps.surface->levels[0].texels[1], (Texel{128, 255, 0, 255}));  // half of the occlusion
    EXPECT_EQ(one.maps.normal->levels[0].texels[2], (Texel{0, 0, 255, 255}));
    EXPECT_EQ(one.maps.emission->levels[0].texels[1], (Texel{0, 255, 0, 255}));
    EXPECT_EQ(one.emission, (std::array{1.0f, 0.5f, 0.0f}));
    EXPECT_EQ(one.roughness, 0.5f);
    EXPECT_EQ(one.opacity, 0.25f);
    EXPECT_TRUE(one.translucent());

    const auto elsewhere = material(R"({"index":0,"texCoord":1})");
    EXPECT_EQ(elsewhere->materials[0].maps.emission, nullptr);
    EXPECT_EQ(elsewhere->materials[0].emission, (std::array{0.0f, 0.0f, 0.0f}));
    EXPECT_EQ(elsewhere->missing_images.size(), 1u);
}

TEST_F(Gltf, ObjMaterialsHaveBumpsAndOpacity) {
    write("tiny.png", tiny_png());
    write("a.mtl", "newmtl glass\nKd 1 1 1\nd 0.5\nmap_Bump -bm 0.5 tiny.png\nmap_Ke tiny.png\n");
    const LoadedMesh mesh = load_mesh(write("a.obj",
                                            "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nusemtl glass\n"
                                            "f 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n"));
    const MeshMaterial& glass = mesh.asset->paint->materials[0];
    EXPECT_EQ(glass.opacity, 0.5f);
    EXPECT_NE(glass.maps.normal, nullptr);
    EXPECT_NE(glass.maps.emission, nullptr);
    EXPECT_EQ(glass.emission, (std::array{1.0f, 1.0f, 1.0f}));
}

TEST_F(Gltf, SkinsAndMorphTargetsAreInTheirRestPose) {
    const std::vector<float> moves{0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0};
    const std::vector<std::uint8_t> joints(16, 0);
    std::vector<float> weights(16, 0.0f);
    for (std::size_t v = 0; v < 4; ++v) weights[4 * v] = 1.0f;
    write("data.bin", tetrahedron() + bytes_of(moves) + bytes_of(joints) + bytes_of(weights));
    Document document;
    document.buffers = R"([{"byteLength":200,"uri":"data.bin"}])";
    document.views =
        R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24},{"buffer":0,"byteOffset":72,"byteLength":48},
{"buffer":0,"byteOffset":120,"byteLength":16},{"buffer":0,"byteOffset":136,"byteLength":64}])";
    document.accessors =
        R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},
{"bufferView":2,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":3,"componentType":5121,"count":4,"type":"VEC4"},
{"bufferView":4,"componentType":5126,"count":4,"type":"VEC4"}])";
    // Half of a target that moves the corner at x = 1 to x = 3: volume 2/6.
    document.primitives = R"([{"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":2}]}])";
    document.nodes = R"([{"mesh":0,"weights":[0.5]}])";
    EXPECT_NEAR(loaded(document).closedness.signed_volume, 2.0 / 6.0, 1e-12);
    // A joint of twice the size below a node at x = 5; the place of the mesh's own node does not count.
    document.primitives = R"([{"attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4},"indices":1}])";
    document.nodes =
        R"([{"mesh":0,"skin":0,"translation":[0,100,0]},{"children":[2],"translation":[5,0,0]},{"scale":[2,2,2]}])";
    document.roots = "[0,1]";
    document.more = R"(,"skins":[{"joints":[2]}])";
    const LoadedMesh skinned = loaded(document);
    EXPECT_NEAR(skinned.closedness.signed_volume, 8.0 / 6.0, 1e-12);
    for (const MeshAsset::Vertex& vertex : skinned.asset->vertices) {
        EXPECT_GE(vertex.position[0], 5.0f);
        EXPECT_LE(vertex.position[1], 2.0f);
    }
    document.more = R"(,"skins":[{"joints":[7]}])";
    EXPECT_NE(error_of(document), "no error");
}

TEST_F(Gltf, ChunksOfAGlbLieWithinTheFile) {
    const std::string whole = glb(Document{}.text(), "");
    EXPECT_EQ(error_of(whole, "a.glb"), "no error");
    EXPECT_EQ(error_of("glTF", "a.glb"), "is a GLB file that ends early");
    EXPECT_EQ(error_of(whole.substr(0, 100), "a.glb").substr(0, 37), "is a GLB file of 100 bytes that names");
    const auto with_number = [&](std::size_t at, std::uint32_t number) {
        std::string changed = whole;
        std::memcpy(changed.data() + at, &number, sizeof number);
        return error_of(changed, "a.glb");
    };
    EXPECT_EQ(with_number(4, 1), "is GLB version 1, not 2");
    EXPECT_NE(with_number(8, 3).find("that names 3 as its length"), std::string::npos);
    EXPECT_NE(with_number(12, 0xffffffff).find("has a chunk of 4294967295 bytes"), std::string::npos);
    EXPECT_EQ(with_number(16, 0x004e4942), "is a GLB file whose one JSON chunk does not come first");
}

}  // namespace
}  // namespace tumble::gltf_file_test
