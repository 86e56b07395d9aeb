// Random places for spheres in a box without contact: random sequential addition (Renyi 1958).
#pragma once

#include "scene/description/shape_bounds.h"
#include "scene/keys/random.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct ScatterPlaces {
    std::vector<Vec3> offsets;  // from the center of the box, in the order of the spheres; fewer if they do not fit
};

/// An offset for each sphere, uniform in the box of that full size. It is redrawn (up to `attempts` times per sphere)
/// while the sphere, whose center is relative to its offset, is nearer than `clearance` to an earlier one.
ScatterPlaces scatter_places(const std::vector<BoundingSphere>& spheres, const Vec3& size, double clearance,
                             std::int64_t attempts, Random& random);

}  // namespace tumble
