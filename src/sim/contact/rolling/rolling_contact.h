// A curved body whose only contact is one point on a fixed plane or on the middle of a fixed face, under gravity alone,
// follows the equations of rolling and sliding (rolling_path.h) instead of a contact solver, which is of first order in
// the step.
#pragma once

#include "sim/contact/rolling/rolling_path.h"
#include "sim/dynamics/forces.h"
#include "sim/geometry/manifold.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

struct RolledContact {
    std::uint32_t body = 0, manifold = 0;
    int point = 0;  // of the manifold
    RollingPlane plane;
    RigidState start, end;
    Impulse impulse;       // N s, N m s about the origin of the bodies' coordinates, of the contact on the body
    double slipped = 0.0;  // J, lost by friction
};

/// True for a curved body without joints and without rolling and spinning friction.
bool may_roll(const Body& body);
/// The motion of a body through `span` s (m/s^2: gravity), if it can roll and touches nothing else at its start.
/// `of_body`: indices of all manifolds of the body.
std::optional<RolledContact> roll_alone(std::uint32_t body, const std::vector<Body>& bodies,
                                        const std::vector<Manifold>& manifolds, std::span<const std::uint32_t> of_body,
                                        const ForceField& forces, const Vec3& gravity, double span);
/// Gives the body's manifolds the impulses of that motion.
void give_impulses(const RolledContact& rolled, std::vector<Manifold>& manifolds,
                   std::span<const std::uint32_t> of_body);

}  // namespace tumble
