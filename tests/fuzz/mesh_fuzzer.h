// Shared by the fuzz targets of the mesh formats.
#pragma once

#include "../support/folder.h"
#include "scene/mesh/mesh_loader.h"

#include <cstdint>
#include <string>

namespace tumble {

/// Loads the bytes as a mesh file of that extension (".obj"): the result is a mesh or a MeshError.
inline int fuzz_mesh(const char* extension, const std::uint8_t* data, std::size_t size) {
    static const TestFolder folder;
    const std::filesystem::path file = folder / (std::string("mesh") + extension);
    write_text(file, std::string(reinterpret_cast<const char*>(data), size));
    try {
        load_mesh_objects(file);
    } catch (const MeshError&) {
    }
    return 0;
}

}  // namespace tumble
