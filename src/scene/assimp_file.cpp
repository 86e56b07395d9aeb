#include "scene/assimp_file.h"

#include "core/safe_text.h"


#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr unsigned deepest_node = 1000;   // nested transforms: beyond, a file is made to exhaust the stack

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

/// What assimp says, as far as one wants to read it: some of its messages quote the rest of the file, bytes and all.
std::string readable(std::string message) {
    for (char& c : message) if (static_cast<unsigned char>(c) > 0x7e) c = '?';
    return safe_text(message, 120);
}

void add_mesh(const aiMesh& mesh, const Transform& transform, bool with_normals, MeshFile& result) {
    if (!mesh.mVertices) return;
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D& v = mesh.mVertices[i];
        result.add_position(transform.linear * Vec3(as_written(v.x), as_written(v.y), as_written(v.z)) +
                            transform.offset);
    }
    const bool mirrored = transform.linear.determinant() < 0.0;
    const Mat3 turn = (mirrored ? -1.0 : 1.0) * normal_transform(transform.linear);
    std::vector<MeshFile::Corner> polygon;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        polygon.clear();
        for (unsigned i = 0; i < face.mNumIndices; ++i) {
            const unsigned index = face.mIndices[i];
            if (index >= mesh.mNumVertices) {
                throw MeshError(fmt::format("has a face with vertex {} of {}", index, mesh.mNumVertices));
            }
            polygon.push_back({first + index, Vec3::Zero()});
            if (with_normals && mesh.mNormals) {
                const aiVector3D& n = mesh.mNormals[index];
                polygon.back().normal = unit_or_zero(turn * Vec3(n.x, n.y, n.z));
            }
        }
        if (mirrored) std::reverse(polygon.begin(), polygon.end());
        result.add_polygon(polygon);
    }
}

void add_node(const aiNode& node, const aiScene& scene, const Transform& parent, bool with_normals, unsigned depth,
              MeshFile& result) {
    if (depth > deepest_node) throw MeshError(fmt::format("nests its nodes deeper than {}", deepest_node));
    const Transform transform = parent.then(node.mTransformation);
    if (node.mNumMeshes > 0) result.begin_object();   // an `o` or `g` of an OBJ, a node of a glTF
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene.mNumMeshes) throw MeshError("names a part that it does not hold");
        add_mesh(*scene.mMeshes[node.mMeshes[i]], transform, with_normals, result);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
        add_node(*node.mChildren[i], scene, transform, with_normals, depth + 1, result);
    }
}

/// Remembers what is opened besides the file itself: a glTF's buffers.
class Files : public Assimp::DefaultIOSystem {
public:
    Files(std::string file, std::vector<std::filesystem::path>& others) : file_(std::move(file)), others_(others) {}

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        Assimp::IOStream* const stream = DefaultIOSystem::Open(name, mode);
        if (stream != nullptr && name != file_) others_.push_back(name);
        return stream;
    }

private:
    std::string file_;
    std::vector<std::filesystem::path>& others_;
};

}  // namespace

MeshFile read_with_assimp(const std::filesystem::path& file, bool with_normals) {
    MeshFile result;
    Assimp::Importer importer;
    importer.SetIOHandler(new Files(file.string(), result.other_files));   // the importer deletes it
    // Its check of the data and nothing else: its own cutting of polygons ends the program (an assertion) on a mesh
    // of nothing but degenerate faces, and welding and normals are ours.
    const aiScene* scene = nullptr;
    std::string problem;
    try {
        scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
        problem = importer.GetErrorString();
    } catch (const std::exception& error) {
        problem = error.what();
    }
    if (!scene || !scene->mRootNode) throw MeshError("cannot be read: " + readable(problem));
    add_node(*scene->mRootNode, *scene, {}, with_normals, 0, result);
    return result;
}

}  // namespace tumble
