// The distance of a point from a box at the origin.
#pragma once

#include <algorithm>
#include <cmath>

namespace tumble {

// Quilez 2008, Distance functions: exact outside; inside, the negative distance to the nearest face.
inline float box_distance(float x, float y, float z, float half_x, float half_y, float half_z) {
    const float qx = std::abs(x) - half_x, qy = std::abs(y) - half_y, qz = std::abs(z) - half_z;
    const float ox = std::max(qx, 0.0f), oy = std::max(qy, 0.0f), oz = std::max(qz, 0.0f);
    return std::sqrt(ox * ox + oy * oy + oz * oz) + std::min(std::max(qx, std::max(qy, qz)), 0.0f);
}

}  // namespace tumble
