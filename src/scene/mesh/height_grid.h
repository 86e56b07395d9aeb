// Heights over a rectangle, from a file, and the solid below them.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <filesystem>
#include <vector>

namespace tumble {

struct HeightGrid {
    int columns = 0, rows = 0;    // along x and along z, at least 2 each
    std::vector<double> heights;  // row by row, each along x
};

/// A gray PNG file, whose samples of 8 or 16 bits become 0 to 1, or a CSV file of numbers: a line for each row. Throws
/// InputError at the file's line and column, and UnreadableFile.
HeightGrid read_height_grid(const std::filesystem::path& file);

/// The closed surface of the solid between the heights (m) and a flat bottom at `bottom` (m), below all of them, over a
/// rectangle of that size (m) about the origin. Smooth normals on top.
MeshFile height_field_mesh(const HeightGrid& grid, double size_x, double size_z, double bottom);

}  // namespace tumble
