// Rigid-body mode of several bodies: the component of their motion that contact among them cannot change, that of one
// rigid body with their momentum and angular momentum. With M the masses, J the inertia tensor and L the angular
// momentum about the common center c,
//   V = sum(P) / M,   W = J^-1 L,   v_i = V + W x (x_i - c) + the rest.
// The kinetic energies of the two components add up: weighted by mass they are orthogonal.
#pragma once

#include "sim/dynamics/body.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class RigidMode {
public:
    /// All sums are about `origin`, the same for all bodies: near them, which may be far from the world's origin.
    void add(const Body& body, const Vec3& origin);
    void add(const RigidMode& other);
    /// Computes c, V and W. Precondition: all bodies were added.
    void finish();

    double energy() const;                                            // J
    BodyVelocity at(const Vec3& position, const Vec3& origin) const;  // V + W x (x - c), W

    /// Scales the body's motion relative to the mode, and keeps its displacement in the step.
    void scale_rest(double scale, const Vec3& origin, Body& body) const;

private:
    double mass_ = 0.0;           // kg
    Vec3 moment_ = Vec3::Zero();  // kg m, first moment of the masses
    Vec3 momentum_ = Vec3::Zero(), angular_momentum_ = Vec3::Zero();
    Mat3 inertia_ = Mat3::Zero();
    Vec3 center_ = Vec3::Zero();  // m, relative to the origin
    Vec3 velocity_ = Vec3::Zero(), angular_velocity_ = Vec3::Zero();
};

/// For a free island, which is going to move by h (velocity + correction): a correction u moves a body past its
/// momentum P, and the angular momentum changes by h u x P. All bodies rotate together (about c, by W more) so that the
/// sum is conserved and none moves relative to another:
///     sum m (r + h u) x (W x r) + I W = -sum h u x P - C,   r = x - c,
/// with C the moment (N m s) that the bodies have been given beyond zero, `carried`.
void keep_angular_momentum(std::span<const std::uint32_t> island, std::vector<Body>& bodies, double h,
                           const Vec3& carried = Vec3::Zero());

}  // namespace tumble
