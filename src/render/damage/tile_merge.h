// Merges the cells of a grid over the frame into few rectangles.
#pragma once

#include "core/rectangle.h"

#include <algorithm>
#include <vector>

namespace tumble {

struct CellGrid {
    int columns = 0, rows = 0;
    int cell = 1;               // pixels
    int width = 0, height = 0;  // of the frame, pixels; the last column and row may be cut off
};

/// The rectangles of all cells for which `selected(column, row)` is true, in pixels: runs along a row, extended downward
/// while the rows below have the same run. They do not overlap. They may include cells for which `free(column, row)` is
/// true where that makes fewer rectangles.
template <class Selected, class Free>
std::vector<Rectangle> cell_rectangles(const CellGrid& grid, Selected selected, Free free) {
    enum Cell : char { none, spare, needed };
    std::vector<char> left(std::size_t(grid.columns) * std::size_t(grid.rows));
    const auto at = [&](int column, int row) -> char& { return left[std::size_t(row * grid.columns + column)]; };
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            at(column, row) = selected(column, row) ? needed : free(column, row) ? spare : none;
    std::vector<Rectangle> rectangles;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            if (at(column, row) != needed) continue;
            int end = column, bottom = row;
            for (int x = column; x < grid.columns && at(x, row) != none; ++x)
                if (at(x, row) == needed) end = x + 1;
            const auto same_run = [&](int y) {
                if (column > 0 && at(column - 1, y) == needed) return false;
                if (end < grid.columns && at(end, y) == needed) return false;
                bool any = false;
                for (int x = column; x < end; ++x) {
                    if (at(x, y) == none) return false;
                    any = any || at(x, y) == needed;
                }
                return any;
            };
            do {
                for (int x = column; x < end; ++x) at(x, bottom) = none;
                ++bottom;
            } while (bottom < grid.rows && same_run(bottom));
            const int x = column * grid.cell, y = row * grid.cell;
            rectangles.push_back(
                {x, y, std::min(end * grid.cell, grid.width) - x, std::min(bottom * grid.cell, grid.height) - y});
        }
    return rectangles;
}

template <class Selected>
std::vector<Rectangle> cell_rectangles(const CellGrid& grid, Selected selected) {
    return cell_rectangles(grid, selected, [](int, int) { return false; });
}

}  // namespace tumble
