// The connected pieces of a surface, and which of their triangles are wound against the others.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// Triangles that share an edge which no third one has are of one sheet; where more meet, sheets end.
struct MeshComponents {
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    std::vector<std::uint32_t> sheet;   // of each triangle: the first one of its sheet; none: it has one side only (Moebius)
    std::vector<char> turned;           // is it wound against the first one?
    std::vector<char> rim;              // does its sheet end at one of its edges?
};

MeshComponents find_sheets(const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tumble
