// The bodies as boxes, balls and planes that take sky light from each other, and a spatial hash to find the few within
// reach of a point (Teschner et al. 2003). Collisions of the hash only cost time: every distance is exact.
#pragma once

#include "render/body_looks.h"
#include "render/draw_list.h"
#include "sim/snapshot.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace tumble {

/// As shaders/occlusion.glsl reads it. A ball has its radius, negated, in half_size.x.
struct Occluder {
    glm::vec4 center;        // relative to the eye; w: body number
    glm::vec4 orientation;   // x, y, z, w
    glm::vec4 half_size;     // m; w: reach, m
};

struct OccluderGrid {
    std::vector<Occluder> occluders;
    std::vector<std::int32_t> cells;      // a table of list starts, then the lists of indices, each ended by -1
    std::uint32_t table_size = 1;         // a power of two
    double cell_size = 1.0;               // m
    std::vector<glm::vec4> planes;        // unit normal and the eye's height; at most most_occluding_planes
};

inline constexpr std::size_t most_occluding_planes = 4;

OccluderGrid make_occluder_grid(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view);

}  // namespace tumble
