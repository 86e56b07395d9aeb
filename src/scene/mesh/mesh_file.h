// A mesh file as triangles: OBJ, STL, PLY and glTF.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Something is wrong with a mesh file; what() completes the sentence "mesh ... ".
struct MeshError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// All triangles of a file, the transforms of its nodes applied, in the file's own units. Counter-clockwise outside.
struct MeshFile {
    struct Corner {
        std::uint32_t position = 0;      // index into positions
        Vec3 normal = Vec3::Zero();      // unit, or zero where the file has none
    };
    std::vector<Vec3> positions;         // not welded
    std::vector<std::array<Corner, 3>> triangles;
    std::vector<std::size_t> objects;    // the first triangle of each object of the file, ascending
    std::vector<std::filesystem::path> other_files;   // that were opened for it: a glTF's buffers

    /// Throws MeshError when the position is not finite or beyond 1e30, whose squares would be none, or is one too many.
    void add_position(const Vec3& position);
    /// The triangles added from here on are another object.
    void begin_object();
    /// Cuts the polygon into triangles. Throws MeshError when it or the file has too many corners.
    void add_polygon(const std::vector<Corner>& corners);
    void add_triangle(const std::array<Corner, 3>& corners);
    /// Throw MeshError when a polygon of so many corners, or so many more triangles or positions, would be too many.
    static void check_corners(std::size_t corners);
    void check_more_triangles(std::uint64_t more) const;
    void check_more_positions(std::uint64_t more) const;
};

/// Whether a file without a reader of our own may be imported in a child process.
enum class MeshImports { in_child_process, refused };

/// The file's ending says its kind: a reader of our own, or assimp (assimp_import.h).
/// Throws MeshError when the file is missing, of another kind, unreadable or empty, or holds indices or numbers that
/// mean nothing. Opens the file itself and, for glTF, the files of its buffers under its folder; nothing else.
MeshFile read_mesh_file(const std::filesystem::path& file, MeshImports imports = MeshImports::in_child_process);

/// Text of a mesh file as a message shows it: printable, and cut to so many characters.
std::string readable(std::string_view text, std::size_t longest);

/// A number that a file or a library stored as a float, as it was meant: 0.1f is 0.100000001490116, and the shortest
/// decimal that means the same float is what was written if that had up to 7 digits. So a mesh keeps its exact size.
double as_written(float value);

Vec3 unit_or_zero(const Vec3& v);

}  // namespace tumble
