// The connected components of a triangle mesh, and the triangles in them that are wound inconsistently.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// Two triangles that share an edge without a third one are in one component; an edge with more triangles is a border.
struct MeshComponents {
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    // index of the first triangle of each triangle's component; none: the component is one-sided (Moebius)
    std::vector<std::uint32_t> sheet;
    std::vector<char> flipped;  // true if wound opposite to the first triangle
    std::vector<char> rim;      // true if an edge of its component is a border
};

MeshComponents find_sheets(const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tumble
