// A lattice of points on a flat face and how open to the sky they are, as sky_openness.h has it for points anywhere. What
// is the same for all of them, the normal and the way to the probes, is worked out once: a third of the price.
#pragma once

#include "render/ambient_occlusion/occluders.h"

#include <span>
#include <vector>

namespace tumble {

class TexelGrid {
public:
    /// columns x rows points corner + i across + j along, row after row (m, relative to the same point as occluders), in
    /// place of those before. All are open.
    void set(const Eigen::Vector3f& corner, const Eigen::Vector3f& across, const Eigen::Vector3f& along,
             const Eigen::Vector3f& normal, int columns, int rows);

    /// Multiplies each point's share by what a body leaves of it. `reach`: the face's own, m.
    void darken(const Occluder& occluder, float reach);

    /// The same for a plane: points q with normal . q + height = 0.
    void darken(const Eigen::Vector3f& plane_normal, float plane_height, float reach);

    /// The points' shares of the sky's light.
    std::span<float> open() { return {open_.data(), std::size_t(columns_) * std::size_t(rows_)}; }
    std::span<const float> open() const { return {open_.data(), std::size_t(columns_) * std::size_t(rows_)}; }

private:
    Eigen::Vector3f corner_, across_, along_, normal_;
    int columns_ = 0, rows_ = 0;
    std::vector<float> i_, j_;   // of each point
    std::vector<float> open_;
};

}  // namespace tumble
