// Compressed meshes of glTF: Draco (KHR_draco_mesh_compression) and meshoptimizer (EXT_meshopt_compression).
#pragma once

#include "scene/mesh/gltf_json.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

inline constexpr const char* draco_extension = "KHR_draco_mesh_compression";
/// The extension and its later name.
inline constexpr std::array meshopt_extensions = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

/// The member of "extensions" with that name, or null.
const Json* find_extension(const Json& holder, const char* name);

struct DracoMesh {
    std::vector<std::uint32_t> indices;
    std::map<std::uint64_t, std::vector<std::array<float, 4>>> attributes;  // by their numbers in Draco's data
};

/// The triangles of a compressed mesh, and those of its attributes. Throws MeshError where the data are broken or hold
/// more triangles than a scene may have.
DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint64_t>& attributes);

/// The bytes of a buffer view, from its extension and the compressed bytes. Throws MeshError.
std::string decode_meshopt(const Json& extension, std::string_view bytes);

}  // namespace tumble
