#include "scene/keys/scatter_places.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tumble {
namespace {

/// The placed spheres in a grid with cells as wide as the largest diameter, so that only the 27 cells around a place
/// can contain neighbors. Only for lookups, never iterated over.
class NeighborBoxes {
public:
    NeighborBoxes(const std::vector<BoundingSphere>& spheres, double clearance)
        : spheres_(spheres), clearance_(clearance) {
        double largest = 0.0;
        for (const BoundingSphere& sphere : spheres) largest = std::max(largest, sphere.radius);
        cell_ = 2.0 * largest + clearance;
    }

    bool is_free(std::size_t sphere, const Vec3& center) const {
        const auto [x, y, z] = cell_of(center);
        for (std::int64_t i = x - 1; i <= x + 1; ++i)
            for (std::int64_t j = y - 1; j <= y + 1; ++j)
                for (std::int64_t k = z - 1; k <= z + 1; ++k)
                    if (touches(key(i, j, k), sphere, center)) return false;
        return true;
    }

    void add(std::size_t sphere, const Vec3& center) {
        const auto [x, y, z] = cell_of(center);
        cells_[key(x, y, z)].push_back({sphere, center});
    }

private:
    struct Placed {
        std::size_t sphere;
        Vec3 center;
    };

    std::array<std::int64_t, 3> cell_of(const Vec3& p) const {
        const Vec3 c = p / cell_;
        return {std::int64_t(std::floor(c.x())), std::int64_t(std::floor(c.y())), std::int64_t(std::floor(c.z()))};
    }

    /// Two cells with one key are harmless, because distances are tested.
    static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
        return std::uint64_t(x) * 0x9e3779b97f4a7c15u ^ std::uint64_t(y) * 0xc2b2ae3d27d4eb4fu ^
               std::uint64_t(z) * 0x165667b19e3779f9u;
    }

    bool touches(std::uint64_t cell, std::size_t sphere, const Vec3& center) const {
        const auto found = cells_.find(cell);
        if (found == cells_.end()) return false;
        return std::any_of(found->second.begin(), found->second.end(), [&](const Placed& other) {
            const double reach = spheres_[sphere].radius + spheres_[other.sphere].radius + clearance_;
            return (center - other.center).squaredNorm() <= reach * reach;
        });
    }

    const std::vector<BoundingSphere>& spheres_;
    double clearance_;
    double cell_;  // m
    std::unordered_map<std::uint64_t, std::vector<Placed>> cells_;
};

}  // namespace

ScatterPlaces scatter_places(const std::vector<BoundingSphere>& spheres, const Vec3& size, double clearance,
                             std::int64_t attempts, Random& random) {
    NeighborBoxes neighbourhood(spheres, clearance);
    ScatterPlaces places;
    for (std::size_t sphere = 0; sphere < spheres.size(); ++sphere) {
        for (std::int64_t attempt = 0; attempt < attempts; ++attempt) {
            const Vec3 offset = random.in_box(0.5 * size);
            const Vec3 center = offset + spheres[sphere].center;
            if (!neighbourhood.is_free(sphere, center)) continue;
            neighbourhood.add(sphere, center);
            places.offsets.push_back(offset);
            break;
        }
        if (places.offsets.size() <= sphere) break;
    }
    return places;
}

}  // namespace tumble
