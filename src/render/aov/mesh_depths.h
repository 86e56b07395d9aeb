// Intersection of triangles with the rays of pixels. Adjacent triangles of a mesh leave no gap: both decide by the same
// number with opposite signs.
#pragma once

#include "core/vector.h"
#include "render/aov/visibility_buffer.h"
#include "scene/description/mesh_paint.h"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

struct MeshTriangles {
    std::span<const Vec3> vertices;          // camera frame, m
    std::span<const std::uint32_t> indices;  // three per triangle, counter-clockwise seen from outside
    bool closed;                             // back faces are not visible
    const MeshPaint* holes = nullptr;        // of its textures; null: none
};

/// Stores the triangles that are nearer than the values in the buffer. `ray_x`: of each column.
void find_triangles(const MeshTriangles& mesh, std::uint32_t surface, const PinholeCamera& camera,
                    std::span<const double> ray_x, VisibilityBuffer& map);

}  // namespace tumble
