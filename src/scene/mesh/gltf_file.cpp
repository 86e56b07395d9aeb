#include "scene/mesh/mesh_readers.h"

#include "scene/mesh/gltf_buffers.h"
#include "scene/mesh/gltf_compression.h"
#include "scene/mesh/gltf_json.h"
#include "scene/mesh/gltf_materials.h"
#include "scene/mesh/gltf_rest_pose.h"
#include "scene/mesh/mesh_images.h"
#include "scene/mesh/mesh_transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace tumble {
namespace {

enum class Mode { triangles = 4, strip = 5, fan = 6 };

/// A primitive of a mesh that has triangles.
struct Primitive {
    const Json* item;
    Mode mode;
    std::uint64_t positions, triangles;
    std::optional<std::uint64_t> normals, indices, colors;
    std::vector<std::uint64_t> uv_sets;
    std::uint32_t material = MeshFile::no_material;  // index into the materials of the mesh
};

class SceneReader {
public:
    SceneReader(const Json& document, GltfBuffers& buffers, const std::filesystem::path& folder)
        : document_(document),
          buffers_(buffers),
          images_(folder),
          material_reader_(document, buffers, images_),
          rest_pose_(document, buffers) {}

    MeshFile read() {
        std::vector<Visit> open;
        push(roots(), {}, open);
        while (!open.empty()) {  // depth first, with an explicit stack, because a file may have any depth
            const Visit visit = open.back();
            open.pop_back();
            const Json& node = require_item(document_, "nodes", visit.node);
            const MeshTransform transform = visit.parent.then(local_transform(node));
            if (const auto mesh = find_whole(node, "mesh")) add_mesh(*mesh, node, transform);
            push(whole_numbers(node, "children"), transform, open);
        }
        for (const GltfMaterial& material : materials_) mesh_.materials.push_back(material.look);
        mesh_.take(images_);
        return std::move(mesh_);
    }

private:
    struct Visit {
        std::uint64_t node;
        MeshTransform parent;
    };

    /// The nodes of the scene; without scenes, all nodes that are no child.
    std::vector<std::uint64_t> roots() const {
        if (find_member(document_, "scenes"))
            return whole_numbers(require_item(document_, "scenes", find_whole(document_, "scene").value_or(0)),
                                 "nodes");
        std::vector<std::uint64_t> result;
        const Json* nodes = find_member(document_, "nodes");
        if (!nodes || !nodes->is_array()) return result;
        std::vector<char> is_child(nodes->size(), 0);
        for (const Json& node : *nodes)
            for (const std::uint64_t child : whole_numbers(node, "children"))
                if (child < is_child.size()) is_child[child] = 1;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) result.push_back(i);
        return result;
    }

    /// The nodes of glTF form a forest: each is visited once, so there are neither cycles nor branches that double.
    void push(const std::vector<std::uint64_t>& nodes, const MeshTransform& parent, std::vector<Visit>& open) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
            require_item(document_, "nodes", *node);
            if (*node >= visited_.size()) visited_.resize(document_["nodes"].size(), false);
            if (visited_[*node]) throw MeshError(fmt::format("has node {} twice in its tree of nodes", *node));
            visited_[*node] = true;
            open.push_back({*node, parent});
        }
    }

    /// Primitives without triangles are dropped once, so that nodes that refer to them cost nothing.
    const std::vector<Primitive>& primitives_of(std::uint64_t mesh) {
        const auto [entry, is_new] = meshes_.try_emplace(mesh);
        if (!is_new) return entry->second;
        const Json* list = find_member(require_item(document_, "meshes", mesh), "primitives");
        if (!list || !list->is_array()) throw MeshError("has a mesh without \"primitives\"");
        for (const Json& item : *list) {
            const std::uint64_t mode = find_whole(item, "mode").value_or(4);
            if (mode > 6) throw MeshError(fmt::format("has an unknown \"mode\" of {}", mode));
            if (mode < 4) continue;  // points and lines
            if (const Json* draco = find_extension(item, draco_extension)) decompress(item, *draco);
            const Json* attributes = find_member(item, "attributes");
            if (!attributes || !find_member(*attributes, "POSITION")) continue;  // nothing to draw
            Primitive primitive{};
            primitive.item = &item;
            primitive.mode = Mode(mode);
            primitive.positions = require_whole(*attributes, "POSITION");
            primitive.normals = find_whole(*attributes, "NORMAL");
            primitive.indices = find_whole(item, "indices");
            primitive.colors = find_whole(*attributes, "COLOR_0");
            for (int set = 0; const auto uv = find_whole(*attributes, fmt::format("TEXCOORD_{}", set).c_str()); ++set)
                primitive.uv_sets.push_back(*uv);
            if (const auto material = find_whole(item, "material")) primitive.material = material_number(*material);
            const std::uint64_t corners = primitive.indices ? buffers_.count_indices(*primitive.indices)
                                                            : buffers_.count_vectors(primitive.positions);
            if (corners < 3) continue;
            primitive.triangles = primitive.mode == Mode::triangles ? corners / 3 : corners - 2;
            entry->second.push_back(primitive);
        }
        return entry->second;
    }

    void decompress(const Json& primitive, const Json& draco) {
        const Json *attributes = find_member(primitive, "attributes"), *numbers = find_member(draco, "attributes");
        if (!attributes || !numbers || !numbers->is_object())
            throw MeshError(fmt::format("has a mesh of {} without \"attributes\"", draco_extension));
        std::vector<std::uint64_t> wanted;
        for (const auto& [name, number] : numbers->items()) wanted.push_back(require_whole(*numbers, name.c_str()));
        const DracoMesh made = decode_draco(buffers_.whole_view(draco), wanted);
        for (const auto& [name, number] : numbers->items())
            if (const auto accessor = find_whole(*attributes, name.c_str()))
                buffers_.give(*accessor, made.attributes.at(require_whole(*numbers, name.c_str())));
        buffers_.give(require_whole(primitive, "indices"), made.indices);
    }

    std::uint32_t material_number(std::uint64_t material) {
        const auto [entry, is_new] = number_of_material_.try_emplace(material, std::uint32_t(materials_.size()));
        if (is_new) materials_.push_back(material_reader_.read(material));
        return entry->second;
    }

    /// Vectors of an attribute, one for each position; none if their number differs.
    std::vector<std::array<float, 4>> attribute(std::uint64_t accessor, std::size_t positions) {
        const std::size_t components = buffers_.components(accessor);
        if (components < 2 || components > 4) return {};
        std::vector<std::array<float, 4>> values = buffers_.values(accessor, components);
        if (values.size() != positions) values.clear();
        return values;
    }

    /// Places in the texture, of each vertex of a primitive.
    std::vector<std::array<float, 2>> uvs_of(const Primitive& primitive, std::size_t positions) {
        std::vector<std::array<float, 2>> uvs;
        if (primitive.material == MeshFile::no_material) return uvs;
        const GltfMaterial& material = materials_[primitive.material];
        if (!material.has_images() || material.place->uv_set >= primitive.uv_sets.size()) return uvs;
        for (const auto& uv : attribute(primitive.uv_sets[material.place->uv_set], positions))
            uvs.push_back(material.placed(uv[0], uv[1]));
        return uvs;
    }

    void add_mesh(std::uint64_t mesh, const Json& node, const MeshTransform& transform) {
        const std::vector<Primitive>& primitives = primitives_of(mesh);
        if (!primitives.empty()) mesh_.begin_object();
        for (const Primitive& primitive : primitives) add_primitive(primitive, node, transform);
    }

    void add_primitive(const Primitive& primitive, const Json& node, const MeshTransform& of_node) {
        mesh_.check_more_triangles(primitive.triangles);
        mesh_.check_more_positions(buffers_.count_vectors(primitive.positions));
        auto positions = buffers_.vectors(primitive.positions);
        std::vector<std::array<float, 3>> normals;
        if (primitive.normals && buffers_.count_vectors(*primitive.normals) == positions.size())
            normals = buffers_.vectors(*primitive.normals);
        rest_pose_.add_targets(node, *primitive.item, positions, normals);
        const MeshTransform transform =
            rest_pose_.skin(node, *primitive.item, positions, normals) ? MeshTransform() : of_node;
        const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
        for (const auto& position : positions) mesh_.add_position(transform.point(position));
        const std::vector<std::array<float, 2>> uvs = uvs_of(primitive, positions.size());
        std::vector<std::array<float, 4>> colors;
        if (primitive.colors) colors = attribute(*primitive.colors, positions.size());
        mesh_.colored = mesh_.colored || !colors.empty();
        std::vector<std::uint32_t> indices;
        if (primitive.indices) indices = buffers_.indices(*primitive.indices);

        const auto corner = [&](std::uint64_t at) {
            const std::uint64_t v = primitive.indices ? indices[at] : at;
            if (v >= positions.size())
                throw MeshError(fmt::format("has a face with vertex {} of {}", v, positions.size()));
            MeshFile::Corner result;
            result.position = first + static_cast<std::uint32_t>(v);
            result.material = primitive.material;
            if (!uvs.empty()) result.uv = uvs[v];
            if (!colors.empty()) result.color = {colors[v][0], colors[v][1], colors[v][2]};
            if (!normals.empty()) result.normal = transform.normal(normals[v]);
            return result;
        };
        for (std::uint64_t t = 0; t < primitive.triangles; ++t) {
            std::array<std::uint64_t, 3> at{3 * t, 3 * t + 1, 3 * t + 2};
            if (primitive.mode == Mode::strip) at = t % 2 ? std::array{t + 1, t, t + 2} : std::array{t, t + 1, t + 2};
            if (primitive.mode == Mode::fan) at = {0, t + 1, t + 2};
            if (transform.mirrored()) std::swap(at[0], at[2]);
            mesh_.add_triangle({corner(at[0]), corner(at[1]), corner(at[2])});
        }
    }

    const Json& document_;
    GltfBuffers& buffers_;
    MeshFile mesh_;
    MeshImages images_;
    GltfMaterials material_reader_;
    GltfRestPose rest_pose_;
    std::vector<GltfMaterial> materials_;  // of the primitives so far
    std::map<std::uint64_t, std::uint32_t> number_of_material_;
    std::vector<bool> visited_;
    std::map<std::uint64_t, std::vector<Primitive>> meshes_;
};

/// Rejects required extensions that change the geometry and cannot be read. Others change the appearance only.
void check_extensions(const Json& document) {
    const Json* required = find_member(document, "extensionsRequired");
    if (!required || !required->is_array()) return;
    for (const char* name : {"EXT_mesh_gpu_instancing"})
        if (std::find(required->begin(), required->end(), name) != required->end())
            throw MeshError(fmt::format("needs {}, which cannot be read: export it without", name));
}

void check_version(const Json& document) {
    const Json* asset = find_member(document, "asset");
    const Json* version = asset ? find_member(*asset, "version") : nullptr;
    if (!version || !version->is_string()) throw MeshError("is no glTF file: it has no \"asset\" with a \"version\"");
    const std::string& text = version->get_ref<const std::string&>();
    if (text.starts_with("1.")) throw UnsupportedGltf("is glTF 1, not 2.0");
    if (!text.starts_with("2.")) throw MeshError(fmt::format("is glTF {}, not 2.0", readable(text, 10)));
}

struct Chunks {
    std::string_view json, binary;
};

Chunks split_glb(std::string_view bytes) {
    const auto take = [&] {
        std::uint32_t number = 0;
        if (bytes.size() < sizeof number) throw MeshError("is a GLB file that ends early");
        std::memcpy(&number, bytes.data(), sizeof number);  // x86-64 is little-endian, like GLB
        bytes.remove_prefix(sizeof number);
        return number;
    };
    const std::size_t whole = bytes.size();
    take();  // "glTF"
    if (const std::uint32_t version = take(); version != 2)
        throw MeshError(fmt::format("is GLB version {}, not 2", version));
    const std::uint32_t length = take(), head = 12;
    if (length > whole || length < head)
        throw MeshError(fmt::format("is a GLB file of {} bytes that names {} as its length", whole, length));
    bytes = bytes.substr(0, length - head);
    Chunks chunks;
    constexpr std::uint32_t json_kind = 0x4e4f534a, binary_kind = 0x004e4942;  // "JSON", "BIN"
    for (bool first = true; !bytes.empty(); first = false) {
        const std::uint32_t size = take(), kind = take();
        if (first != (kind == json_kind)) throw MeshError("is a GLB file whose one JSON chunk does not come first");
        if (size > bytes.size())
            throw MeshError(fmt::format("has a chunk of {} bytes where {} are left", size, bytes.size()));
        if (first)
            chunks.json = bytes.substr(0, size);
        else if (kind == binary_kind && chunks.binary.empty())
            chunks.binary = bytes.substr(0, size);
        bytes.remove_prefix(size);
    }
    return chunks;
}

}  // namespace

MeshFile read_gltf(std::string_view bytes, const std::filesystem::path& folder) {
    const Chunks chunks = bytes.starts_with("glTF") ? split_glb(bytes) : Chunks{bytes, {}};
    const Json document = parse_json(chunks.json);
    check_version(document);
    check_extensions(document);
    GltfBuffers buffers(document, chunks.binary, bytes.size(), folder);
    MeshFile mesh = SceneReader(document, buffers, folder).read();
    mesh.other_files.insert(mesh.other_files.end(), buffers.other_files().begin(), buffers.other_files().end());
    mesh.in_meters = true;
    return mesh;
}

}  // namespace tumble
