// A mesh file as triangles: OBJ, STL, PLY and glTF, read by assimp.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace tumble {

/// Something is wrong with a mesh file; what() completes the sentence "mesh ... ".
struct MeshError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// All triangles of a file, the transforms of its nodes applied, in the file's own units. Counter-clockwise outside.
struct MeshFile {
    struct Corner {
        std::uint32_t position;   // index into positions
        Vec3 normal;              // unit, or zero where the file has none
    };
    std::vector<Vec3> positions;               // finite; not welded
    std::vector<std::array<Corner, 3>> triangles;
};

/// Throws MeshError when the file is missing, of another kind, unreadable or empty, or holds indices or numbers that
/// mean nothing. Normals of STL files are left out: they are those of the facets and say nothing of smoothness.
MeshFile read_mesh_file(const std::filesystem::path& file);

}  // namespace tumble
