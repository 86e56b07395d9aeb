// A mesh file as triangles: OBJ, STL, PLY, glTF and formats of assimp.
#pragma once

#include "core/triangle_mesh.h"
#include "core/vector.h"
#include "scene/description/mesh_paint.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class MeshImages;

/// A fault of a mesh file; what() completes the sentence "mesh ... ".
struct MeshError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// All triangles of a file, with the transforms of its nodes applied, in the file's units. Counter-clockwise seen from
/// outside.
struct MeshFile {
    static constexpr std::uint32_t no_material = ~std::uint32_t(0);
    struct Corner {
        std::uint32_t position = 0;                    // index into positions
        std::uint32_t material = no_material;          // index into materials, of the triangle
        Vec3 normal = Vec3::Zero();                    // unit, or zero if the file has none
        std::array<float, 2> uv{};                     // (0, 0) is the top left corner of the texture
        std::array<float, 3> color{1.0f, 1.0f, 1.0f};  // linear light
    };
    std::vector<Vec3> positions;  // not welded
    std::vector<std::array<Corner, 3>> triangles;
    std::vector<std::size_t> objects;                // the first triangle of each object of the file, ascending
    std::vector<std::filesystem::path> other_files;  // additional files that were opened: buffers, materials, images
    std::vector<MeshMaterial> materials;
    std::vector<std::string> missing_images;  // names of images that could not be read
    bool colored = false;                     // vertices have colors
    bool in_meters = false;                   // the format states unit and up axis: positions are in m, with y up

    /// Throws MeshError if the position is not finite or beyond 1e30 (its square would overflow), or if there are too
    /// many.
    void add_position(const Vec3& position);
    /// Later triangles belong to another object.
    void begin_object();
    /// The files and the missing ones.
    void take(const MeshImages& images);
    /// Triangulates the polygon. Throws MeshError if it or the file has too many corners.
    void add_polygon(const std::vector<Corner>& corners);
    void add_triangle(const std::array<Corner, 3>& corners);
    /// Throw MeshError if a polygon of this many corners, or this many more triangles or positions, would exceed the
    /// limits.
    static void check_corners(std::size_t corners);
    void check_more_triangles(std::uint64_t more) const;
    void check_more_positions(std::uint64_t more) const;
};

/// Import of a file without a reader of Tumble's: allowed in a child process, or refused.
enum class MeshImports { in_child_process, refused };

/// The file's ending determines the reader: one of Tumble's, or assimp (mesh_readers.h). Throws MeshError if the file
/// is missing, of another kind, unreadable or empty, or has invalid indices or numbers, or has a broken image. Opens
/// the file itself and the files of its buffers, materials and images in its folder and below; nothing else.
MeshFile read_mesh_file(const std::filesystem::path& file, MeshImports imports = MeshImports::in_child_process);

/// Text of a mesh file for a message: printable, and cut to this many characters.
std::string readable(std::string_view text, std::size_t longest);

/// The decimal number behind a value stored as a float: 0.1f is 0.100000001490116, and the shortest decimal that rounds
/// to the same float is the original one if that had up to 7 digits. A mesh thus keeps its exact size.
double as_written(float value);

Vec3 unit_or_zero(const Vec3& v);

/// Triangles of a polygon given by its corners in order, as indices into them, with the same orientation. Convex
/// polygons become fans, others are triangulated by ear clipping (Meisters 1975). A polygon that is not simple is cut
/// nevertheless: its edges are kept, so that a closed surface stays closed. 2000 corners take 2 to 30 ms.
std::vector<std::array<std::uint32_t, 3>> cut_polygon(const std::vector<Vec3>& corners);

/// Throws MeshError if it cannot be read as a regular file (core/input_file.h), or is larger than the limit.
std::string read_mesh_bytes(const std::filesystem::path& file);

/// The file of that name after following links; it must be in the folder (after following links) or below. Throws
/// MeshError.
std::filesystem::path file_below(const std::filesystem::path& folder, const std::string& name);

/// The looks of a loaded mesh from the materials and colors of its file. `corners`: of the triangles of `mesh`, in
/// their order. Null if none of them has a material and no vertex a color.
std::shared_ptr<const MeshPaint> make_paint(const MeshFile& file, const TriangleMesh& mesh,
                                            const std::vector<std::array<MeshFile::Corner, 3>>& corners);

}  // namespace tumble
