// glTF 2.0 files (Khronos, ISO/IEC 12113): the triangles of the scene's nodes. Both as JSON and as GLB.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <filesystem>
#include <string_view>

namespace tumble {

/// A kind of glTF without a reader in Tumble: version 1.
struct UnsupportedGltf : MeshError {
    using MeshError::MeshError;
};

/// `bytes`: content of the file. Buffers may be files in the folder and below. Throws MeshError, or UnsupportedGltf.
MeshFile read_gltf(std::string_view bytes, const std::filesystem::path& folder);

}  // namespace tumble
