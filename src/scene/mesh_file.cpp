#include "scene/mesh_file.h"

#include "scene/limits.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace tumble {
namespace {

constexpr unsigned deepest_node = 1000;   // nested transforms: beyond, a file is made to exhaust the stack

std::string lower_extension(const std::filesystem::path& file) {
    std::string text = file.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return c < 0x80 ? std::tolower(c) : c; });
    return text;
}

/// assimp keeps floats: the file's 0.1 arrives as 0.100000001490116. The shortest decimal that means the same float
/// is what the file said if it said it in up to 7 digits, so a mesh written as text keeps its exact size.
double as_written(float value) {
    if (!std::isfinite(value)) throw MeshError("holds a coordinate that is not a finite number");
    char text[32];
    const auto written = std::to_chars(text, text + sizeof text, value);
    double result = 0.0;
    std::from_chars(text, written.ptr, result);
    return result;
}

Vec3 as_written(const aiVector3D& v) { return {as_written(v.x), as_written(v.y), as_written(v.z)}; }

struct Transform {
    Mat3 linear = Mat3::Identity();
    Vec3 offset = Vec3::Zero();

    Transform then(const aiMatrix4x4& m) const {
        Mat3 inner;
        inner << as_written(m.a1), as_written(m.a2), as_written(m.a3), as_written(m.b1), as_written(m.b2),
            as_written(m.b3), as_written(m.c1), as_written(m.c2), as_written(m.c3);
        const Vec3 shift(as_written(m.a4), as_written(m.b4), as_written(m.c4));
        return {linear * inner, linear * shift + offset};
    }
};

/// Normals turn with the cofactors of the transform: no inverse, and right for mirrors too once the winding follows.
Mat3 normal_transform(const Mat3& m) {
    Mat3 cofactors;
    cofactors.col(0) = m.col(1).cross(m.col(2));
    cofactors.col(1) = m.col(2).cross(m.col(0));
    cofactors.col(2) = m.col(0).cross(m.col(1));
    return cofactors;
}

Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.norm();
    return length > 0.0 && std::isfinite(length) ? Vec3(v / length) : Vec3(Vec3::Zero());
}

void add_mesh(const aiMesh& mesh, const Transform& transform, bool with_normals, MeshFile& result) {
    if (!(mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) || !mesh.mVertices) return;
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    if (result.triangles.size() + mesh.mNumFaces > static_cast<std::size_t>(limits::mesh_triangles)) {
        throw MeshError(fmt::format("has more than {} triangles", limits::mesh_triangles));
    }
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const Vec3 p = transform.linear * as_written(mesh.mVertices[i]) + transform.offset;
        if (!p.allFinite()) throw MeshError("holds a coordinate that is not a finite number");
        result.positions.push_back(p);
    }
    const bool mirrored = transform.linear.determinant() < 0.0;
    const Mat3 turn = (mirrored ? -1.0 : 1.0) * normal_transform(transform.linear);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices < 3) continue;   // points and lines
        if (face.mNumIndices > 3) throw MeshError("holds a polygon that cannot be cut into triangles");
        std::array<MeshFile::Corner, 3> triangle;
        for (unsigned i = 0; i < 3; ++i) {
            const unsigned index = face.mIndices[i];
            if (index >= mesh.mNumVertices) {
                throw MeshError(fmt::format("has a face with vertex {} of {}", index, mesh.mNumVertices));
            }
            triangle[i] = {first + index, Vec3::Zero()};
            if (with_normals && mesh.mNormals) {
                const aiVector3D& n = mesh.mNormals[index];
                triangle[i].normal = unit_or_zero(turn * Vec3(n.x, n.y, n.z));
            }
        }
        if (mirrored) std::swap(triangle[1], triangle[2]);
        result.triangles.push_back(triangle);
    }
}

void add_node(const aiNode& node, const aiScene& scene, const Transform& parent, bool with_normals, unsigned depth,
              MeshFile& result) {
    if (depth > deepest_node) throw MeshError(fmt::format("nests its nodes deeper than {}", deepest_node));
    const Transform transform = parent.then(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene.mNumMeshes) throw MeshError("names a part that it does not hold");
        add_mesh(*scene.mMeshes[node.mMeshes[i]], transform, with_normals, result);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
        add_node(*node.mChildren[i], scene, transform, with_normals, depth + 1, result);
    }
}

void check_file(const std::filesystem::path& file, const std::string& extension) {
    if (extension != ".obj" && extension != ".stl" && extension != ".ply" && extension != ".gltf" && extension != ".glb") {
        throw MeshError("is of an unknown kind: .obj, .stl, .ply, .gltf and .glb can be read");
    }
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) throw MeshError("does not exist");
    if (!std::filesystem::is_regular_file(status)) throw MeshError("is not a file");
    const auto size = std::filesystem::file_size(file, error);
    if (error) throw MeshError("cannot be read: " + error.message());
    if (size == 0) throw MeshError("is empty");
    if (size > static_cast<std::uintmax_t>(limits::mesh_bytes)) {
        throw MeshError(fmt::format("is larger than {} MiB", limits::mesh_bytes >> 20));
    }
}

}  // namespace

MeshFile read_mesh_file(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    check_file(file, extension);

    Assimp::Importer importer;
    // Normals of our own making need no help from assimp; its checks come first, since readers trust the file.
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure | aiProcess_Triangulate);
    if (!scene || !scene->mRootNode) {
        throw MeshError(fmt::format("cannot be read: {}", importer.GetErrorString()));
    }
    MeshFile result;
    add_node(*scene->mRootNode, *scene, {}, extension != ".stl", 0, result);
    if (result.triangles.empty()) throw MeshError("holds no triangles");
    return result;
}

}  // namespace tumble
