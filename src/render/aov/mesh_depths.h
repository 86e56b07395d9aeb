// Triangles under the rays of pixels. Neighbors in a mesh leave no gap: the two sides of an edge are told apart by the
// same number, with the other sign.
#pragma once

#include "core/vector.h"
#include "render/aov/visibility_buffer.h"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

struct MeshTriangles {
    std::span<const Vec3> vertices;             // in the camera's frame, m
    std::span<const std::uint32_t> indices;     // three a triangle, counter-clockwise from outside
    bool closed;                                // back faces are not seen
};

/// Those that are nearer than what is in the map already. `ray_x` is of each column.
void find_triangles(const MeshTriangles& mesh, std::uint32_t surface, const PinholeCamera& camera,
                    std::span<const double> ray_x, VisibilityBuffer& map);

/// The share of each corner in the point where a ray meets the triangle (barycentric; they add up to 1).
std::array<double, 3> corner_shares(const std::array<Vec3, 3>& corners, const Vec3& ray);

}  // namespace tumble
