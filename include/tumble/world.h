// The simulation.
#pragma once

#include "contacts.h"
#include "joints.h"
#include "scene.h"
#include "snapshot.h"

#include <cstddef>
#include <memory>
#include <vector>

TUMBLE_BEGIN

struct BodyProperties {
    double mass = 0.0;    // kg; infinity for fixed and kinematic bodies
    Vec3 inertia;         // kg m^2, principal moments about the center of mass, ascending
    Vec3 center_of_mass;  // m, body frame, from the body's origin
};

/// One simulation, at time 0 when made. Not for several threads at once; several worlds are independent of each other.
class World {
public:
    /// Builds the bodies: masses, inertia, convex hulls. The number of threads, 1 to 1024, changes the time taken,
    /// never a byte of the result. Throws Error (input) for another number, and for a mesh that has no hull.
    explicit World(const Scene& scene, int threads = 1);
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Advances by one fixed step, or by the steps of one frame. Throws Error (run) with the step and the body when a
    /// state is not finite; the world cannot advance after that.
    void advance_step();
    void advance_frame();

    /// Records impacts, contacts and energy losses from now on. Call it at time 0. The motion is the same.
    void record_contacts();
    /// Contacts of the last advance_frame(), or of the start. Throws Error (input) without record_contacts().
    FrameContacts contacts() const;

    /// The state of all bodies: at time 0 that of the scene.
    Snapshot snapshot() const;
    /// States of all joints, in the order of the scene; forces of the last advance_frame(), otherwise 0.
    std::vector<JointState> joints() const;
    /// The bonds of breakable bodies that failed in the last frame.
    std::vector<Break> breaks() const;
    /// Finds the contacts of the present poses, which costs about as much as a step.
    Energies energies() const;
    /// Properties of the body of that index in scene order. Throws Error (input) for an index of no body.
    BodyProperties properties(std::size_t body) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

TUMBLE_END
