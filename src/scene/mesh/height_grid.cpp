#include "scene/mesh/height_grid.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/safe_text.h"
#include "output/png_reader.h"
#include "scene/toml/error_text.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace tumble {
namespace {

void check_size(std::int64_t columns, std::int64_t rows, const SourceLocation& at) {
    if (columns < 2 || rows < 2)
        throw InputError(at, fmt::format("a height field needs 2 x 2 heights at least (given {} x {})", columns, rows));
    if (columns * rows > limits::heights)
        throw InputError(
            at, fmt::format("holds too many heights: at most {} (given {} x {})", limits::heights, columns, rows));
}

HeightGrid read_png_grid(const std::filesystem::path& file) {
    const GrayImage image = read_gray_png(file, limits::heights);
    check_size(image.width, image.height, {file.string(), 0, 0});
    HeightGrid grid{image.width, image.height, {}};
    grid.heights.reserve(image.samples.size());
    for (const std::uint16_t sample : image.samples) grid.heights.push_back(double(sample) / 65535.0);
    return grid;
}

/// Numbers between commas, a row in each line that is not empty.
class CsvGrid {
public:
    CsvGrid(std::string_view text, const std::string& file) : text_(text), file_(file) {
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
    }

    HeightGrid read() {
        while (!text_.empty()) {
            ++line_;
            const std::size_t end = std::min(text_.find('\n'), text_.size());
            std::string_view row = text_.substr(0, end);
            text_.remove_prefix(std::min(end + 1, text_.size()));
            if (row.ends_with('\r')) row.remove_suffix(1);
            if (row.find_first_not_of(" \t") != row.npos) add_row(row);
        }
        check_size(grid_.columns, grid_.rows, {file_, 0, 0});
        return std::move(grid_);
    }

private:
    void add_row(std::string_view row) {
        const std::size_t before = grid_.heights.size();
        for (std::size_t at = 0; at <= row.size();) {
            const std::size_t end = std::min(row.find(',', at), row.size());
            grid_.heights.push_back(number(row.substr(at, end - at), int(at) + 1));
            at = end + 1;
        }
        const int count = int(grid_.heights.size() - before);
        if (grid_.rows++ == 0) grid_.columns = count;
        if (count != grid_.columns)
            throw InputError({file_, line_, 1}, fmt::format("a row of heights has as many numbers as the first, {} "
                                                            "(given {})",
                                                            grid_.columns, count));
        if (grid_.heights.size() > std::size_t(limits::heights))
            check_size(grid_.columns, grid_.rows, {file_, line_, 1});
    }

    double number(std::string_view cell, int column) const {
        const std::size_t first = std::min(cell.find_first_not_of(" \t"), cell.size());
        const std::size_t last = cell.find_last_not_of(" \t");
        const std::string_view text = last == cell.npos ? cell.substr(first) : cell.substr(first, last + 1 - first);
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
            !limits::coordinate.contains(value))
            throw InputError({file_, line_, column + int(first)},
                             fmt::format("a height must be a number from {} to {} (given \"{}\")",
                                         number_text(limits::coordinate.min), number_text(limits::coordinate.max),
                                         safe_text(std::string(text.substr(0, 40)))));
        return value;
    }

    std::string_view text_;
    const std::string& file_;
    int line_ = 0;  // from 1
    HeightGrid grid_;
};

class FieldMesh {
public:
    FieldMesh(const HeightGrid& grid, double size_x, double size_z, double bottom)
        : grid_(grid), step_x_(size_x / (grid.columns - 1)), step_z_(size_z / (grid.rows - 1)) {
        for (int row = 0; row < grid.rows; ++row)
            for (int column = 0; column < grid.columns; ++column)
                mesh_.add_position({(column - 0.5 * (grid.columns - 1)) * step_x_, height(column, row),
                                    (row - 0.5 * (grid.rows - 1)) * step_z_});
        add_top();
        add_walls(bottom);
    }

    MeshFile finish() { return std::move(mesh_); }

private:
    double height(int column, int row) const {
        return grid_.heights[std::size_t(row) * std::size_t(grid_.columns) + std::size_t(column)];
    }
    std::uint32_t index(int column, int row) const { return std::uint32_t(row * grid_.columns + column); }

    /// By differences of the neighbors.
    MeshFile::Corner corner(int column, int row) const {
        const int west = std::max(column - 1, 0), east = std::min(column + 1, grid_.columns - 1);
        const int north = std::max(row - 1, 0), south = std::min(row + 1, grid_.rows - 1);
        const double slope_x = (height(east, row) - height(west, row)) / ((east - west) * step_x_);
        const double slope_z = (height(column, south) - height(column, north)) / ((south - north) * step_z_);
        MeshFile::Corner made;
        made.position = index(column, row);
        made.normal = Vec3(-slope_x, 1.0, -slope_z).normalized();
        return made;
    }

    /// Each cell is cut along the diagonal whose ends differ less in height, which keeps ridges and valleys.
    void add_top() {
        for (int row = 0; row + 1 < grid_.rows; ++row)
            for (int column = 0; column + 1 < grid_.columns; ++column) {
                const auto a = corner(column, row), b = corner(column + 1, row), c = corner(column, row + 1),
                           d = corner(column + 1, row + 1);
                const double along = std::fabs(height(column, row) - height(column + 1, row + 1)),
                             across = std::fabs(height(column + 1, row) - height(column, row + 1));
                if (along <= across) {
                    mesh_.add_triangle({a, c, d});
                    mesh_.add_triangle({a, d, b});
                } else {
                    mesh_.add_triangle({a, c, b});
                    mesh_.add_triangle({b, c, d});
                }
            }
    }

    /// From the border down to the bottom, and the bottom as triangles about its center.
    void add_walls(double bottom) {
        std::vector<std::uint32_t> border;  // counterclockwise seen from above
        for (int row = 0; row + 1 < grid_.rows; ++row) border.push_back(index(0, row));
        for (int column = 0; column + 1 < grid_.columns; ++column) border.push_back(index(column, grid_.rows - 1));
        for (int row = grid_.rows - 1; row > 0; --row) border.push_back(index(grid_.columns - 1, row));
        for (int column = grid_.columns - 1; column > 0; --column) border.push_back(index(column, 0));
        const auto first = std::uint32_t(mesh_.positions.size());
        for (const std::uint32_t above : border) {
            const Vec3 top = mesh_.positions[above];
            mesh_.add_position({top.x(), bottom, top.z()});
        }
        const auto center = std::uint32_t(mesh_.positions.size());
        mesh_.add_position({0.0, bottom, 0.0});
        const auto at = [](std::uint32_t position) {
            MeshFile::Corner made;
            made.position = position;
            return made;
        };
        for (std::size_t i = 0; i < border.size(); ++i) {
            const std::size_t next = (i + 1) % border.size();
            const auto low = first + std::uint32_t(i), low_next = first + std::uint32_t(next);
            mesh_.add_triangle({at(border[i]), at(low), at(low_next)});
            mesh_.add_triangle({at(border[i]), at(low_next), at(border[next])});
            mesh_.add_triangle({at(low_next), at(low), at(center)});
        }
    }

    const HeightGrid& grid_;
    double step_x_, step_z_;  // m
    MeshFile mesh_;
};

}  // namespace

HeightGrid read_height_grid(const std::filesystem::path& file) {
    const std::string bytes = read_regular_file(file, limits::mesh_bytes);
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return read_png_grid(file);
    const std::string name = file.string();
    return CsvGrid(bytes, name).read();
}

MeshFile height_field_mesh(const HeightGrid& grid, double size_x, double size_z, double bottom) {
    return FieldMesh(grid, size_x, size_z, bottom).finish();
}

}  // namespace tumble
