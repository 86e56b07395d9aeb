// Impacts, contacts and the momentum balance of a frame, as plain values: the rows of the tables --impacts, --contacts
// and --balance. A frame's records cover the time from the frame before it. Bodies are named by their index in the
// scene; vectors are in the world frame; normals point from A to B, and impulses and forces act on B (the opposite ones
// on A).
#pragma once

#include "core/vector.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// Features of the two surfaces that meet. In edge_face and face_face a manifold of two or more points shares the
/// features.
enum class ContactFeatures : std::uint8_t { vertex_face, edge_edge, edge_face, face_face, sphere };

/// One impulse: of one contact, in one pass of the impact law (notes eqs. 14 and 20).
struct ImpactRecord {
    double time = 0.0;        // s
    bool exact_time = false;  // whether it is the time of the impact itself, else the step's that resolves it
    std::size_t a = 0, b = 0;
    Vec3 point = Vec3::Zero();   // m
    Vec3 normal = Vec3::Zero();  // unit, from A to B
    ContactFeatures features = ContactFeatures::vertex_face;
    double speed_before = 0.0, speed_after = 0.0;  // m/s, v_rel along the normal; negative: approaching
    double restitution = 0.0;                      // e that the law used
    double impulse = 0.0;                          // N s along the normal
    Vec3 friction = Vec3::Zero();                  // N s on B, across the normal; in the contact's last pass
    Vec3 friction_moment = Vec3::Zero();           // N m s on B, of friction that acts beside the point
    int pass = 0;                                  // of the law, from 0
};

/// One point of a resting or sliding contact: means over the frame.
struct ContactRecord {
    enum class State : std::uint8_t { stick, slip, asleep };
    std::size_t a = 0, b = 0;
    Vec3 point = Vec3::Zero();   // m, at the last step of the frame that had it
    Vec3 normal = Vec3::Zero();  // unit, from A to B
    ContactFeatures features = ContactFeatures::vertex_face;
    double gap = 0.0;                      // m; negative: overlap
    double normal_force = 0.0;             // N
    Vec3 tangential_force = Vec3::Zero();  // N on B
    Vec3 moment = Vec3::Zero();            // N m on B, beside the forces: torsional friction, along the normal
    Vec3 slip = Vec3::Zero();              // m/s, of B's point relative to A's, across the normal
    State state = State::stick;
};

/// Linear and angular impulse (about the center of mass) on a body.
struct ImpulseSum {
    Vec3 linear = Vec3::Zero();   // N s
    Vec3 angular = Vec3::Zero();  // N m s
};

/// The change of a dynamic body's momenta over a frame is the sum of all four.
struct BalanceRecord {
    std::size_t body = 0;
    ImpulseSum external;     // gravity, wind, forces at points
    ImpulseSum impacts;      // impact records
    ImpulseSum contacts;     // contact records
    ImpulseSum corrections;  // of the method: bounces held through a step, clamps, energy budget, rounding
};

struct ContactRecords {
    std::vector<ImpactRecord> impacts;    // in the order in which they happened
    std::vector<ContactRecord> contacts;  // ascending by bodies and point
    std::vector<BalanceRecord> balance;   // of all dynamic bodies, ascending
};

}  // namespace tumble
