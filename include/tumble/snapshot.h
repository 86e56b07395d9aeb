// The state of all bodies at one time. SI units, world frame.
#pragma once

#include "vector.h"

#include <cstdint>
#include <vector>

TUMBLE_BEGIN

struct BodyState {
    Vec3 origin;            // m, of the body's own origin: where its shape is drawn
    Vec3 center_of_mass;    // m
    Quat orientation;       // unit
    Vec3 velocity;          // m/s, of the center of mass
    Vec3 angular_velocity;  // rad/s
    bool absent = false;    // a piece that has not broken off, or a body in pieces: it is not drawn
};

struct Snapshot {
    std::int64_t frame = 0;         // the last frame at or before the time
    double time = 0.0;              // s
    std::vector<BodyState> bodies;  // in scene order, fixed ones included
};

/// Over all dynamic bodies.
struct Energies {
    double kinetic = 0.0;                                // J
    double potential = 0.0;                              // J, -sum m g.x
    Vec3 momentum;                                       // kg m/s
    Vec3 angular_momentum;                               // kg m^2/s, about the world origin
    int contacts = 0;                                    // touching contact points
    double max_penetration = 0.0;                        // m, deepest overlap
    double kinetic_linear = 0.0, kinetic_angular = 0.0;  // J, of translation and of rotation
    // J, from the start on; zero without World::record_contacts(). kinetic + potential + elastic + losses - work stays
    // constant.
    double work = 0.0;  // by wind, forces at points, motors and kinematic bodies
    double impact_loss = 0.0, friction_loss = 0.0;
    double elastic = 0.0;     // in joints' springs, at that time
    double motor_work = 0.0;  // the part of `work` by motors of joints
    double joint_heat = 0.0;  // the part of `friction_loss` in joints: friction, dampers, breaking
    double surface = 0.0;     // lost by impacts to the new surfaces of bodies that broke
    double water_loss = 0.0;  // taken by water: by drag, and to move with bodies; below 0 where waves gave more
};

TUMBLE_END
