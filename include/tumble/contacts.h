// Impacts and contacts of a frame. Normals point from A to B; impulses and forces act on B, the opposite ones on A. SI
// units, world frame; bodies by their index in scene order, A before B.
#pragma once

#include "vector.h"

#include <cstddef>
#include <cstdint>
#include <vector>

TUMBLE_BEGIN

/// Features of A and of B that meet; mesh: one of them is a triangle mesh.
enum class ContactFeatures { vertex_face, face_vertex, edge_edge, face_face, sphere, mesh };

/// One impulse at a contact point, in one pass of the impact law.
struct Impact {
    double time = 0.0;        // s
    bool exact_time = false;  // the impact's own time, otherwise the end of the step that resolves it
    std::int64_t frame = 0;   // the last frame at or before the time
    std::size_t a = 0, b = 0;
    Vec3 point;   // m
    Vec3 normal;  // unit
    ContactFeatures features = ContactFeatures::vertex_face;
    double speed_before = 0.0, speed_after = 0.0;  // m/s, n . (velocity of B's point - of A's); negative: approaching
    double restitution = 0.0;                      // that the law used
    double impulse = 0.0;                          // N s along the normal
    Vec3 friction;                                 // N s, across the normal
    int pass = 0;                                  // of the law, from 0
    Vec3 moment;                                   // N m s about the world origin, of both impulses
};

/// One point of a resting or sliding contact. Forces are means over the frame.
struct Contact {
    enum class State { stick, slip, asleep, open };  // open: touching without load
    static constexpr std::size_t nobody = SIZE_MAX;
    std::size_t a = 0;  // `nobody`: a correction of the method that acts on B alone
    std::size_t b = 0;
    Vec3 point;   // m
    Vec3 normal;  // unit; of a correction: along its force, or along its moment if it has no force
    ContactFeatures features = ContactFeatures::vertex_face;
    double gap = 0.0;           // m; negative: overlap
    double normal_force = 0.0;  // N
    Vec3 tangential_force;      // N
    double torsion = 0.0;       // N m about the normal
    Vec3 slip;                  // m/s, of B's point relative to A's, across the normal
    State state = State::open;
    Vec3 moment;  // N m about the world origin, of both forces at their points of each step
};

/// Gravity, wind and forces at points of a dynamic body: means over the frame.
struct ExternalLoad {
    std::size_t body = 0;
    Vec3 force;   // N
    Vec3 moment;  // N m about the world origin
};

/// A bond of a breakable body that failed.
struct Break {
    double time = 0.0;       // s
    std::size_t body = 0;    // the whole body
    std::size_t bond = 0;    // index of the bond in its body
    double area = 0.0;       // m^2
    double tension = 0.0;    // N along the normal; negative: compression
    double bending = 0.0;    // N m, across the normal
    double shear = 0.0;      // N, across the normal
    double torsion = 0.0;    // N m about the normal
    double energy = 0.0;     // J, that the new surface took from the motion
    std::size_t pieces = 0;  // of the body, after it
};

/// Over the frame that ends now, the change of a body's momentum is the sum of its impulses, and of its contact forces
/// and its external load times the frame's duration. The same holds of angular momentum about the world origin and the
/// moments.
struct FrameContacts {
    std::vector<Impact> impacts;      // in order of time
    std::vector<Contact> contacts;    // ascending by bodies
    std::vector<ExternalLoad> loads;  // of all dynamic bodies, ascending
};

TUMBLE_END
