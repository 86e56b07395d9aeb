// A grid of points on a flat face and their sky visibility, as in analytic_occlusion.h for arbitrary points. The normal
// and the offsets of the samples are shared by all points, which takes a third of the time.
#pragma once

#include "render/ambient_occlusion/occluders.h"

#include <span>
#include <vector>

namespace tumble {

/// The points corner + i across + j along, row after row (m, relative to the same point as occluders).
struct GridPoints {
    Eigen::Vector3f corner, across, along;
    Eigen::Vector3f normal;  // unit
    int columns = 0, rows = 0;
};

class TexelGrid {
public:
    /// Replaces the points; all are unoccluded.
    void set(const GridPoints& points);

    /// Multiplies each point's visibility by that past one body. `ao_radius`: AO radius of the face, m.
    void occlude(const Occluder& occluder, float ao_radius);

    /// The same for a plane: points q with normal . q + height = 0.
    void occlude(const Eigen::Vector3f& plane_normal, float plane_height, float ao_radius);

    /// Sky visibility of the points.
    std::span<float> open() { return {open_.data(), count()}; }
    std::span<const float> open() const { return {open_.data(), count()}; }

private:
    std::size_t count() const { return std::size_t(points_.columns) * std::size_t(points_.rows); }

    GridPoints points_;
    std::vector<float> i_, j_;  // of each point
    std::vector<float> open_;
};

}  // namespace tumble
