// A grid of points on a flat face and their sky visibility, as in analytic_occlusion.h for arbitrary points. The normal
// and the offsets of the samples are shared by all points, which takes a third of the time.
#pragma once

#include "render/ambient_occlusion/occluders.h"

#include <span>
#include <vector>

namespace tumble {

class TexelGrid {
public:
    /// Replaces the points by columns x rows points corner + i across + j along, row after row (m, relative to the same
    /// point as occluders), all unoccluded.
    void set(const Eigen::Vector3f& corner, const Eigen::Vector3f& across, const Eigen::Vector3f& along,
             const Eigen::Vector3f& normal, int columns, int rows);

    /// Multiplies each point's visibility by that past one body. `ao_radius`: AO radius of the face, m.
    void occlude(const Occluder& occluder, float ao_radius);

    /// The same for a plane: points q with normal . q + height = 0.
    void occlude(const Eigen::Vector3f& plane_normal, float plane_height, float ao_radius);

    /// Sky visibility of the points.
    std::span<float> open() { return {open_.data(), std::size_t(columns_) * std::size_t(rows_)}; }
    std::span<const float> open() const { return {open_.data(), std::size_t(columns_) * std::size_t(rows_)}; }

private:
    Eigen::Vector3f corner_, across_, along_, normal_;
    int columns_ = 0, rows_ = 0;
    std::vector<float> i_, j_;  // of each point
    std::vector<float> open_;
};

}  // namespace tumble
