// Shared by the fuzz targets of the mesh formats.
#pragma once

#include "../support/folder.h"
#include "../support/tiny_png.h"
#include "scene/mesh/mesh_loader.h"

#include <cstdint>
#include <string>

namespace tumble {

/// A folder with the files that mesh files and their materials may name: an image i.png of 2 x 2 pixels, and the
/// materials a and b of m.mtl.
inline const TestFolder& fuzzed_folder() {
    static const TestFolder folder;
    static const bool filled = [] {
        write_text(folder / "i.png", tiny_png());
        write_text(folder / "m.mtl", "newmtl a\nKd 1 0.5 0\nmap_Kd i.png\nnewmtl b\nKe 0 1 0\nPr 0.3\nPm 1\n");
        return true;
    }();
    (void)filled;
    return folder;
}

/// Loads the bytes as a mesh file of that extension (".obj"): the result is a mesh or a MeshError.
inline int fuzz_mesh(const char* extension, const std::uint8_t* data, std::size_t size) {
    const TestFolder& folder = fuzzed_folder();
    const std::filesystem::path file = folder / (std::string("mesh") + extension);
    write_text(file, std::string(reinterpret_cast<const char*>(data), size));
    try {
        load_mesh_objects(file);
    } catch (const MeshError&) {
    }
    return 0;
}

}  // namespace tumble
