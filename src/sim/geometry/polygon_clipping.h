// Face against face: the incident polygon clipped to the reference face's prism (Sutherland and Hodgman 1974), with a
// label for each point that names its features.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct ClipVertex {
    Vec3 position;
    std::uint64_t feature = 0;  // the vertex's own label
    std::uint32_t edge = 0;     // label of the polygon edge that starts here
};

/// Labels of edges that lie on side i of the reference face, distinct from those of the incident polygon (its edge
/// index).
constexpr std::uint32_t side_label(std::uint32_t i) { return 0x80000u | i; }

/// A polygon with labels, edge i from vertex i to i + 1.
void label_polygon(const std::vector<Vec3>& corners, const std::vector<std::uint32_t>& vertex_labels,
                   std::vector<ClipVertex>& polygon);

/// Clips the polygon to the inside of all side planes of the reference polygon (counterclockwise about `normal`).
/// `spare` is working space.
void clip_to_prism(const std::vector<Vec3>& reference, const Vec3& normal, std::vector<ClipVertex>& polygon,
                   std::vector<ClipVertex>& spare);

}  // namespace tumble
