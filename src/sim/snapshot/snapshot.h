// The poses of all bodies at one frame time: the only data passed from the simulation to the renderer.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// One body at the snapshot's time; world frame.
struct BodyState {
    Vec3 origin;                           // m, of the body's own origin: where its shape is drawn
    Vec3 center_of_mass;                   // m
    Quat orientation;                      // unit
    Vec3 velocity;                         // m/s, of the center of mass
    Vec3 angular_velocity;                 // rad/s
    double mass = 0.0;                     // kg; zero of bodies that are not dynamic, as the next two
    Vec3 momentum = Vec3::Zero();          // kg m/s
    Vec3 angular_momentum = Vec3::Zero();  // kg m^2/s, about the center of mass
    bool asleep = false;
    bool absent = false;  // a piece that has not broken off, or a body in pieces: not to be shown
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [origin, center_of_mass, orientation, velocity, angular_velocity, mass, momentum, angular_momentum,
               asleep, absent] = self;
        archive.keep(origin, center_of_mass, orientation, velocity, angular_velocity, mass, momentum, angular_momentum,
                     asleep, absent);
    }
};

struct Snapshot {
    std::int64_t frame = 0;
    double time = 0.0;              // s, frame / fps
    std::vector<BodyState> bodies;  // in scene order, fixed ones included
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [frame, time, bodies] = self;
        archive.any(frame);
        archive.keep(time);
        archive.by_body(bodies);
    }
};

}  // namespace tumble
