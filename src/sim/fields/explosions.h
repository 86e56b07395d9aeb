// Impulses of [[explosion]] tables on bodies.
//
// An explosion sends its impulse I evenly into all directions. A body takes the impulse of the directions in which it
// is seen from the center:
//
//   J = I / (4 pi) * integral of d over the solid angle of the body.
//
// Each part acts along its direction, so that the whole acts along a line through the center. Of a body with corners
// the integral is Lambert's formula over the outline of its convex hull, -1/2 sum of theta_k m_k, with theta_k the
// angle that an edge spans and m_k the outward normal of the plane through the edge and the center (Arvo 1995,
// "Analytic Methods for Simulated Light Transport", section 4.4). A ball that spans the half angle a has pi sin^2 a.
#pragma once

#include "scene/description/force_fields.h"
#include "sim/geometry/shapes/interface.h"

#include <vector>

namespace tumble {

class Explosions {
public:
    Explosions() = default;
    /// `origin`: m, world, of the coordinates.
    Explosions(const std::vector<ExplosionDescription>& explosions, const Vec3& origin);

    bool empty() const { return explosions_.empty(); }
    /// The explosions with a time in [from, to), s; in the coordinates of the simulation.
    std::vector<ExplosionDescription> within(double from, double to) const;

private:
    std::vector<ExplosionDescription> explosions_;
};

/// N s, along a line through the explosion's center. Zero for a body that the center is in, or that is beyond the
/// radius.
Vec3 impulse_of(const ExplosionDescription& explosion, const CollisionShape& shape, const Pose& pose);

}  // namespace tumble
