// The part of several bodies' motion that contact among them cannot change: that of one rigid body with their momentum and
// angular momentum. With M the masses, J the inertia tensor and L the angular momentum about the common centre c,
//     V = sum(P) / M,   W = J^-1 L,   v_i = V + W x (x_i - c) + the rest.
// The kinetic energies of the two parts add up: weighted by mass they are orthogonal.
#pragma once

#include "sim/dynamics/body.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class RigidMode {
public:
    /// All sums are about `origin`, the same for all: near the bodies, which may be far from the world's.
    void add(const Body& body, const Vec3& origin);
    void add(const RigidMode& other);
    /// After the last body: finds c, V and W.
    void finish();

    double energy() const;                            // J
    BodyVelocity at(const Vec3& position, const Vec3& origin) const;   // V + W x (x - c), W

    /// Scales what is not common in the body's motion, and keeps its way in the step.
    void scale_rest(double scale, const Vec3& origin, Body& body) const;

private:
    double mass_ = 0.0;                               // kg
    Vec3 moment_ = Vec3::Zero();                      // kg m, of the masses
    Vec3 momentum_ = Vec3::Zero(), angular_momentum_ = Vec3::Zero();
    Mat3 inertia_ = Mat3::Zero();
    Vec3 center_ = Vec3::Zero();                      // m, from the origin
    Vec3 velocity_ = Vec3::Zero(), angular_velocity_ = Vec3::Zero();
};

/// Of an island that floats, which is going to move by h (velocity + push): a push u moves a body past its momentum P, and the angular
/// momentum changes by h u x P. All turn together (about c, by W more) so that its sum stays, and none moves against another:
///     sum m (r + h u) x (W x r) + I W = -sum h u x P,   r = x - c.
void keep_angular_momentum(std::span<const std::uint32_t> island, std::vector<Body>& bodies, double h);

}  // namespace tumble
