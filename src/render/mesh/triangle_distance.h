// Proximity of a point to a triangle mesh, with a grid whose cells have the size of the query distance, each with the
// triangles near it.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace tumble {

/// Distance of a point from a triangle, m.
double distance_to_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

class NearSurface {
public:
    using Triangle = std::array<Vec3, 3>;

    /// `within`: query distance, m.
    NearSurface(std::vector<Triangle> triangles, double within);

    bool holds(const Vec3& point) const;

private:
    std::int64_t cell_at(const Vec3& point) const;

    std::vector<Triangle> triangles_;
    double within_, cell_;
    Vec3 low_;
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace tumble
