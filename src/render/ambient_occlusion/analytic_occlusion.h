// Ambient occlusion in closed form: how much of the sky's light reaches a surface point past the bodies near it.
// Each body is a box, a ball or a plane, so the distance d(x) to it is exact. From the point p with normal n two probes
// are sent out to h_k = 0.22 h and h (h: the reach); in the open d(p + n h_k) >= h_k, in a gap it is less:
//   open = product over bodies of (1 - strength * mean over k of clamp(1 - d(p + n h_k) / h_k, 0, 1))
// after Evans 2006, Fast Approximations for Global Illumination on Dynamic Scenes. No noise and nothing screen-space,
// so nothing crawls; and what is out of sight darkens as well.
#pragma once

#include "render/ambient_occlusion/occluders.h"

#include <vector>

namespace tumble {

/// Surface points and what is left of their sky light, component by component so that the compiler makes vectors of
/// them.
struct SurfacePoints {
    std::vector<float> x, y, z;     // relative to the same point as occluders, m
    std::vector<float> nx, ny, nz;  // unit normals
    std::vector<float> open;        // 1: all of the sky's light

    std::size_t size() const { return x.size(); }
    void clear();
    void add(const Eigen::Vector3f& position, const Eigen::Vector3f& normal);
    /// Some of others, as if nothing were near them.
    void add(const SurfacePoints& others, std::size_t first, std::size_t count);
};

/// Multiplies each point's `open` by what a body leaves of it. `reach` is the receiving body's own, m: the smaller
/// counts.
void darken(SurfacePoints& points, const Occluder& occluder, float reach);

/// The same of a single point: what its factor is.
float share_left(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, const Occluder& occluder, float reach);

/// The same for a plane: points q with normal . q + height = 0.
void darken(SurfacePoints& points, const Eigen::Vector3f& plane_normal, float plane_height, float reach);

float share_left(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, const Eigen::Vector3f& plane_normal,
                 float plane_height, float reach);

/// The shares of a point's sky light that a wholly closed gap takes, and where the first probe is, in parts of the
/// reach.
inline constexpr float occlusion_strength = 0.72f;
inline constexpr float near_probe = 0.22f;

}  // namespace tumble
