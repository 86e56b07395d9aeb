
#include "scene/mesh/import_process.h"
#include "scene/mesh/mesh_images.h"
#include "scene/mesh/mesh_readers.h"
#include "scene/mesh/mesh_transform.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <tuple>
#include <vector>

namespace tumble {
namespace {

// Bytes beyond the program's own: importers take about ten times the file, plus fixed tables.
constexpr std::uint64_t import_memory(std::size_t file_bytes) {
    return (std::uint64_t(256) << 20) + 16 * std::uint64_t(file_bytes);
}
constexpr unsigned import_seconds = 60;   // the largest allowed mesh takes about ten
constexpr unsigned deepest_node = 1000;   // nested transforms: a file with more is made to exhaust the stack
constexpr std::size_t shown_bytes = 120;  // characters of assimp's own message
constexpr std::string_view three_mf = ".3mf";

/// Hides all other files, so that a mesh consists of one file only.
class NoOtherFiles : public Assimp::IOSystem {
public:
    bool Exists(const char*) const override { return false; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
    void Close(Assimp::IOStream*) override {}
};

MeshTransform after(const MeshTransform& parent, const aiMatrix4x4& m) {
    Eigen::Matrix4f inner;
    inner << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
    return parent.then(inner);
}

void add_mesh(const aiMesh& mesh, const MeshTransform& transform, MeshFile& result) {
    if (!mesh.mVertices) return;
    result.colored = result.colored || mesh.mColors[0];
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D& v = mesh.mVertices[i];
        result.add_position(transform.point({v.x, v.y, v.z}));
    }
    std::vector<MeshFile::Corner> polygon;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        polygon.clear();
        for (unsigned i = 0; i < face.mNumIndices; ++i) {
            const unsigned index = face.mIndices[i];
            if (index >= mesh.mNumVertices)
                throw MeshError(fmt::format("has a face with vertex {} of {}", index, mesh.mNumVertices));
            MeshFile::Corner& corner = polygon.emplace_back();
            corner.position = first + index;
            corner.material = mesh.mMaterialIndex;
            if (mesh.mTextureCoords[0])
                corner.uv = {mesh.mTextureCoords[0][index].x, 1.0f - mesh.mTextureCoords[0][index].y};
            if (mesh.mColors[0])
                corner.color = {linear_channel(mesh.mColors[0][index].r), linear_channel(mesh.mColors[0][index].g),
                                linear_channel(mesh.mColors[0][index].b)};
            if (!mesh.mNormals) continue;
            const aiVector3D& n = mesh.mNormals[index];
            polygon.back().normal = transform.normal({n.x, n.y, n.z});
        }
        if (transform.mirrored()) std::reverse(polygon.begin(), polygon.end());
        result.add_polygon(polygon);
    }
}

void add_node(const aiNode& node, const aiScene& scene, const MeshTransform& parent, unsigned depth, MeshFile& result) {
    if (depth > deepest_node) throw MeshError(fmt::format("nests its nodes deeper than {}", deepest_node));
    const MeshTransform transform = after(parent, node.mTransformation);
    if (node.mNumMeshes > 0) result.begin_object();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene.mNumMeshes) throw MeshError("names a part that it does not hold");
        add_mesh(*scene.mMeshes[node.mMeshes[i]], transform, result);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], scene, transform, depth + 1, result);
}

/// A material as it passes from the child: its texture as a name, and with bytes if the file holds it.
struct ImportedMaterial {
    std::array<float, 3> color, emission;
    TextureWrap wrap_u, wrap_v;
    bool own;  // stated by the file
};

struct Imported {
    MeshFile mesh;
    std::vector<ImportedMaterial> materials;
    std::vector<std::string> texture_names, textures;  // by material
};

TextureWrap wrap_of(int mode) {
    return mode == aiTextureMapMode_Mirror  ? TextureWrap::mirror
           : mode == aiTextureMapMode_Clamp ? TextureWrap::clamp
                                            : TextureWrap::repeat;
}

std::array<float, 3> color_of(const aiMaterial& material, const char* key, float standard) {
    aiColor4D color(standard, standard, standard, 1.0f);
    material.Get(key, 0, 0, color);
    return {linear_channel(color.r), linear_channel(color.g), linear_channel(color.b)};
}

void add_materials(const aiScene& scene, Imported& result) {
    for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
        const aiMaterial& material = *scene.mMaterials[i];
        aiString file;
        aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        for (const aiTextureType type : {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR})
            if (file.length == 0) material.GetTexture(type, 0, &file, nullptr, nullptr, nullptr, nullptr, modes);
        const aiTexture* embedded = file.length > 0 ? scene.GetEmbeddedTexture(file.C_Str()) : nullptr;
        result.texture_names.emplace_back(file.C_Str());
        result.textures.emplace_back();
        if (embedded && embedded->mHeight == 0)  // a file in the file
            result.textures.back().assign(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth);
        aiString name;
        material.Get(AI_MATKEY_NAME, name);
        const bool own = std::string_view(name.C_Str()) != AI_DEFAULT_MATERIAL_NAME || file.length > 0;
        // A texture replaces the diffuse color, which programs leave at any value.
        result.materials.push_back({color_of(material, "$clr.diffuse", 1.0f), color_of(material, "$clr.emissive", 0.0f),
                                    wrap_of(modes[0]), wrap_of(modes[1]), own});
        if (file.length > 0) result.materials.back().color = {1.0f, 1.0f, 1.0f};
    }
}

/// From the axes and the unit of an FBX file, which assimp reads and does not apply.
MeshTransform fbx_frame(const aiScene& scene) {
    const auto number = [&](const char* key, int standard) {
        std::int32_t value = standard;
        return scene.mMetaData && scene.mMetaData->Get(key, value) ? value : standard;
    };
    Mat3 axes = Mat3::Zero();
    int row = 0;
    for (const auto& [axis, sign, standard] :
         {std::tuple("CoordAxis", "CoordAxisSign", 0), std::tuple("UpAxis", "UpAxisSign", 1),
          std::tuple("FrontAxis", "FrontAxisSign", 2)})
        axes(row++, std::clamp(number(axis, standard), 0, 2)) = number(sign, 1) < 0 ? -1.0 : 1.0;
    if (axes.determinant() == 0.0) axes = Mat3::Identity();  // an axis twice
    float centimeters = 1.0f;
    if (scene.mMetaData) scene.mMetaData->Get("UnitScaleFactor", centimeters);
    constexpr double per_centimeter = 0.01;
    return {(centimeters > 0.0f ? as_written(centimeters) : 1.0) * per_centimeter * axes, Vec3::Zero()};
}

Imported import(std::string_view bytes, const std::string& extension) {
    if (extension == three_mf) return {read_three_mf(bytes), {}, {}, {}};  // assimp crashes on most of them
    Assimp::Importer importer;
    importer.SetIOHandler(new NoOtherFiles);  // the importer deletes it
    // Only assimp's check of the data is used: welding, normals and triangulation follow later.
    const aiScene* scene =
        importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_ValidateDataStructure, extension.c_str() + 1);
    if (!scene || !scene->mRootNode)
        throw MeshError(fmt::format("cannot be read: {}", readable(importer.GetErrorString(), shown_bytes)));
    Imported all;
    MeshFile& result = all.mesh;
    const MeshTransform frame = extension == ".fbx" ? fbx_frame(*scene) : MeshTransform();
    add_node(*scene->mRootNode, *scene, frame, 0, result);
    constexpr std::string_view with_unit[] = {".fbx", ".dae", ".gltf", ".glb"};  // assimp turns Collada itself
    result.in_meters = std::find(std::begin(with_unit), std::end(with_unit), extension) != std::end(with_unit);
    add_materials(*scene, all);
    return all;
}

/// The lists of a mesh, each behind its length, as far as they are complete.
class Lists {
public:
    explicit Lists(std::string_view bytes) : bytes_(bytes) {}

    template <class T>
    std::vector<T> next() {
        std::uint64_t count = 0;
        if (bytes_.size() < sizeof count) throw MeshError("was not imported as a whole");
        std::memcpy(&count, bytes_.data(), sizeof count);
        bytes_.remove_prefix(sizeof count);
        if (count > bytes_.size() / sizeof(T)) throw MeshError("was not imported as a whole");
        std::vector<T> list(count);
        if (count > 0) std::memcpy(static_cast<void*>(list.data()), bytes_.data(), count * sizeof(T));
        bytes_.remove_prefix(count * sizeof(T));
        return list;
    }

    std::string next_text() {
        const std::vector<char> text = next<char>();
        return {text.begin(), text.end()};
    }

private:
    std::string_view bytes_;
};

void add_looks(Lists& lists, const std::filesystem::path& folder, MeshFile& mesh) {
    const auto materials = lists.next<ImportedMaterial>();
    std::vector<std::string> names, textures;
    for (std::size_t i = 0; i < materials.size(); ++i) names.push_back(lists.next_text());
    for (std::size_t i = 0; i < materials.size(); ++i) textures.push_back(lists.next_text());
    MeshImages images(folder);
    constexpr float hole = 0.5f;  // less alpha of an image is a hole
    for (std::size_t i = 0; i < materials.size(); ++i) {
        MeshMaterial& material = mesh.materials.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
            material.color[c] = std::clamp(materials[i].color[c], 0.0f, 1.0f);
            material.emission[c] = std::clamp(materials[i].emission[c], 0.0f, 1.0f);
        }
        material.wrap_u = materials[i].wrap_u;
        material.wrap_v = materials[i].wrap_v;
        material.cutoff = hole;
        if (!textures[i].empty())
            material.texture = images.texture(fmt::format("image {}", readable(names[i], shown_bytes)), textures[i]);
        else if (!names[i].empty())
            material.texture = images.texture(names[i]);
    }
    for (auto& triangle : mesh.triangles)
        for (MeshFile::Corner& corner : triangle)
            if (corner.material >= materials.size() || !materials[corner.material].own)
                corner.material = MeshFile::no_material;
    mesh.take(images);
}

/// A child with a corrupted importer may have written anything, so each value is checked again.
MeshFile checked_mesh(std::string_view bytes, const std::filesystem::path& folder) {
    Lists lists(bytes);
    MeshFile mesh;
    for (const Vec3& position : lists.next<Vec3>()) mesh.add_position(position);
    for (const auto& triangle : lists.next<std::array<MeshFile::Corner, 3>>()) {
        for (const MeshFile::Corner& corner : triangle)
            if (corner.position >= mesh.positions.size() || !corner.normal.allFinite() ||
                !std::isfinite(corner.uv[0]) || !std::isfinite(corner.uv[1]))
                throw MeshError("was imported with a corner that has no valid position or normal");
        mesh.add_triangle(triangle);
    }
    mesh.objects = lists.next<std::size_t>();
    for (std::size_t i = 0; i < mesh.objects.size(); ++i)
        if (mesh.objects[i] > mesh.triangles.size() || (i > 0 && mesh.objects[i] <= mesh.objects[i - 1]))
            throw MeshError("was imported with invalid objects");
    const std::string flags = lists.next_text();
    mesh.in_meters = flags.size() == 2 && flags[0] != 0;
    mesh.colored = flags.size() == 2 && flags[1] != 0;
    add_looks(lists, folder, mesh);
    return mesh;
}

void write(ImportOutput& output, const Imported& all) {
    const MeshFile& mesh = all.mesh;
    output.write(mesh.positions);
    output.write(mesh.triangles);
    output.write(mesh.objects);
    output.write(std::vector<char>{mesh.in_meters, mesh.colored});
    output.write(all.materials);
    for (const auto* texts : {&all.texture_names, &all.textures})
        for (const std::string& text : *texts) output.write(std::vector<char>(text.begin(), text.end()));
}

}  // namespace

bool assimp_reads(const std::string& extension) {
    return extension.size() > 1 && Assimp::Importer().IsExtensionSupported(extension);
}

MeshFile import_with_assimp(std::string_view bytes, const std::filesystem::path& folder, const std::string& extension) {
    const ImportLimits limits{extension == three_mf ? "lib3mf" : "assimp", import_memory(bytes.size()), import_seconds,
                              ".glb, .obj or .stl"};
    const std::string answer =
        run_import(limits, [&](ImportOutput& output) { write(output, import(bytes, extension)); });
    return checked_mesh(answer, folder);
}

}  // namespace tumble
