// Random places for spheres in a box so that none touches another: random sequential addition (Renyi 1958).
#pragma once

#include "scene/keys/random.h"
#include "scene/description/shape_bounds.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct ScatterPlaces {
    std::vector<Vec3> offsets;   // from the middle of the box, in the order of the spheres; fewer when they do not fit
};

/// An offset for each sphere, uniform in the box of that full size, drawn again (up to `attempts` times a sphere) while
/// the sphere, whose center is relative to its offset, comes nearer than `clearance` to an earlier one.
ScatterPlaces scatter_places(const std::vector<BoundingSphere>& spheres, const Vec3& size, double clearance,
                             std::int64_t attempts, Random& random);

}  // namespace tumble
