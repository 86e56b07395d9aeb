// The numbers that the energy table and `tumble info` report.
#pragma once

#include "core/vector.h"

#include <cstddef>

namespace tumble {

/// A row of the energy table: sums over all dynamic bodies, world frame.
struct Measurement {
    double kinetic = 0.0;                  // J
    double kinetic_linear = 0.0;           // J, of translation
    double kinetic_angular = 0.0;          // J, of rotation
    double potential = 0.0;                // J, -sum m g.x
    double elastic = 0.0;                  // J, in springs of joints
    Vec3 momentum = Vec3::Zero();          // kg m/s
    Vec3 angular_momentum = Vec3::Zero();  // kg m^2/s about the world origin
    int contacts = 0;                      // number of touching contact points
    double max_penetration = 0.0;          // m, deepest overlap; 0 without overlaps
};

/// Two bodies that overlap, of which one is dynamic, by their indices in the scene.
struct Overlap {
    std::size_t a = 0, b = 0;  // a < b
    double depth = 0.0;        // m
    double share = 0.0;        // of the smaller one's thickness: the diameter of the ball that fits into it
};

/// One body as the simulation represents it, for `tumble info`.
struct BodyReport {
    double mass = 0.0;                      // kg; infinity for fixed and kinematic bodies
    Vec3 principal_inertia = Vec3::Zero();  // kg m^2, about the center of mass, ascending
    Mat3 inertia = Mat3::Zero();            // kg m^2, about the center of mass, body frame
    Vec3 center_of_mass = Vec3::Zero();     // body frame, from the body's origin
    std::size_t hull_vertices = 0;          // of its convex collision shape; 0 for planes and spheres
    std::size_t triangles = 0;              // of a fixed mesh that collides as it is
};

}  // namespace tumble
