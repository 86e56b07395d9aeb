// Cells of a lattice over the picture as few rectangles.
#pragma once

#include "core/rectangle.h"

#include <algorithm>
#include <vector>

namespace tumble {

struct CellGrid {
    int columns = 0, rows = 0;
    int cell = 1;                // pixels
    int width = 0, height = 0;   // of the picture, pixels: the last column and row may be cut
};

/// The rectangles of all cells for which `wanted(column, row)` is true, in pixels: runs along a row, grown downward while
/// the rows below have the same run. They do not overlap.
template <class Wanted>
std::vector<Rectangle> cell_rectangles(const CellGrid& grid, Wanted wanted) {
    std::vector<char> left(std::size_t(grid.columns) * std::size_t(grid.rows));
    const auto at = [&](int column, int row) -> char& { return left[std::size_t(row * grid.columns + column)]; };
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) at(column, row) = wanted(column, row) ? 1 : 0;
    std::vector<Rectangle> rectangles;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            if (at(column, row) == 0) continue;
            int end = column, bottom = row;
            while (end < grid.columns && at(end, row) != 0) ++end;
            const auto same_run = [&](int y) {
                if (column > 0 && at(column - 1, y) != 0) return false;
                if (end < grid.columns && at(end, y) != 0) return false;
                for (int x = column; x < end; ++x)
                    if (at(x, y) == 0) return false;
                return true;
            };
            do {
                for (int x = column; x < end; ++x) at(x, bottom) = 0;
                ++bottom;
            } while (bottom < grid.rows && same_run(bottom));
            const int x = column * grid.cell, y = row * grid.cell;
            rectangles.push_back(
                {x, y, std::min(end * grid.cell, grid.width) - x, std::min(bottom * grid.cell, grid.height) - y});
        }
    return rectangles;
}

}  // namespace tumble
