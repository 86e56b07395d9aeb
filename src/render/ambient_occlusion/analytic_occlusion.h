// Ambient occlusion in closed form: the sky visibility of a surface point past the bodies near it.
// Each body is a box, a ball or a plane, so the distance d(x) to it is exact. From the point p with normal n, two
// samples are taken at the distances h_k = 0.22 h and h (h: the AO radius). Without an occluder d(p + n h_k) >= h_k; in
// a gap it is less:
//   open = product over bodies of (1 - strength * mean over k of clamp(1 - d(p + n h_k) / h_k, 0, 1))
// after Evans 2006, Fast Approximations for Global Illumination on Dynamic Scenes. There is no noise, and bodies
// outside the view occlude as well, so nothing flickers as the camera moves.
#pragma once

#include "render/ambient_occlusion/occluders.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble {

/// Surface points and their sky visibility, as a structure of arrays so that the compiler vectorizes loops over them.
struct SurfacePoints {
    std::vector<float> x, y, z;     // relative to the same point as occluders, m
    std::vector<float> nx, ny, nz;  // unit normals
    std::vector<float> open;        // sky visibility; 1: unoccluded

    std::size_t size() const { return x.size(); }
    void clear();
    void add(const Eigen::Vector3f& position, const Eigen::Vector3f& normal);
    /// Appends `count` points of others, unoccluded.
    void add(const SurfacePoints& others, std::size_t first, std::size_t count);
};

/// Multiplies each point's `open` by its visibility past one body. `ao_radius`: AO radius of the receiving body, m; the
/// smaller one of the two bodies counts.
void occlude(SurfacePoints& points, const Occluder& occluder, float ao_radius);

/// The same for a single point; returns the factor.
float visibility_past(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, const Occluder& occluder,
                      float ao_radius);

/// The same for a plane: points q with normal . q + height = 0.
void occlude(SurfacePoints& points, const Eigen::Vector3f& plane_normal, float plane_height, float ao_radius);

float visibility_past(const Eigen::Vector3f& position, const Eigen::Vector3f& normal,
                      const Eigen::Vector3f& plane_normal, float plane_height, float ao_radius);

/// Share of a point's sky light that a closed gap takes, and the distance of the first sample in parts of the AO
/// radius.
inline constexpr float occlusion_strength = 0.72f;
inline constexpr float near_sample = 0.22f;

/// The distance of a point from a box at the origin.
/// Quilez 2008, Distance functions: exact outside; inside, the negative distance to the nearest face.
inline float box_distance(float x, float y, float z, float half_x, float half_y, float half_z) {
    const float qx = std::abs(x) - half_x, qy = std::abs(y) - half_y, qz = std::abs(z) - half_z;
    const float ox = std::max(qx, 0.0f), oy = std::max(qy, 0.0f), oz = std::max(qz, 0.0f);
    return std::sqrt(ox * ox + oy * oy + oz * oz) + std::min(std::max(qx, std::max(qy, qz)), 0.0f);
}

}  // namespace tumble
