// Impacts and contacts of a frame, external loads, joints and energy losses, as plain values: the rows of the tables
// --impacts, --contacts and --loads. A frame's records cover the time from the frame before it. Bodies are named by
// their index in the scene, A before B; vectors are in the world frame; normals point from A to B, and impulses and
// forces act on B (the opposite ones on A).
#pragma once

#include "core/vector.h"
#include "sim/snapshot/joint_state.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// Features of A and of B that meet. mesh: one of them is a triangle mesh.
enum class ContactFeatures : std::uint8_t { vertex_face, face_vertex, edge_edge, face_face, sphere, mesh };

struct ImpactTime {
    double time = 0.0;       // s
    std::int64_t frame = 0;  // the last frame at or before it
    bool exact = false;      // true if it is the impact's own time, otherwise the end of the step that resolves it
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [time, frame, exact] = self;
        archive.keep(time, exact);
        archive.any(frame);
    }
};

/// A body when an impact acts on it, or for an impact that a step resolves: at the start of that step.
struct StruckBody {
    Vec3 position = Vec3::Zero();  // m, of the center of mass
    Quat rotation = Quat::Identity();
    Vec3 velocity_before = Vec3::Zero(), velocity_after = Vec3::Zero();                  // m/s, of all its impulses
    Vec3 angular_velocity_before = Vec3::Zero(), angular_velocity_after = Vec3::Zero();  // rad/s
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [position, rotation, velocity_before, velocity_after, angular_velocity_before, angular_velocity_after] =
            self;
        archive.keep(position, rotation, velocity_before, velocity_after, angular_velocity_before,
                     angular_velocity_after);
    }
};

/// One impulse at a contact point: of one contact, in one pass of the impact law (notes eqs. 14 and 20).
struct ImpactRecord {
    ImpactTime when;
    std::size_t a = 0, b = 0;
    Vec3 point = Vec3::Zero();   // m
    Vec3 normal = Vec3::Zero();  // unit
    ContactFeatures features = ContactFeatures::vertex_face;
    double speed_before = 0.0, speed_after = 0.0;  // m/s, v_rel = n . (velocity of B's point - of A's)
    double restitution = 0.0;                      // e that the law used
    double impulse = 0.0;                          // N s along the normal
    Vec3 friction = Vec3::Zero();                  // N s on B, across the normal; with the contact's last pass
    int pass = 0;                                  // of the law, from 0
    Vec3 moment = Vec3::Zero();                    // N m s on B about the world origin, of both impulses
    std::size_t struck_a = 0, struck_b = 0;        // indices into ContactRecords::struck
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [when, a, b, point, normal, features, speed_before, speed_after, restitution, impulse, friction, pass,
               moment, struck_a, struck_b] = self;
        archive.body(a, b);
        archive.enumeration(features, ContactFeatures::mesh);
        archive.keep(when, point, normal, speed_before, speed_after, restitution, impulse, friction, moment);
        archive.any(pass, struck_a, struck_b);
    }
};

/// One point of a resting or sliding contact. Forces are means over the frame.
struct ContactRecord {
    /// open: touching without load.
    enum class State : std::uint8_t { stick, slip, asleep, open };
    std::size_t a = 0;  // `nobody`: a correction of the method that acts on B alone
    std::size_t b = 0;
    Vec3 point = Vec3::Zero();   // m
    Vec3 normal = Vec3::Zero();  // unit; of a correction: along its force, or along its moment if it has no force
    ContactFeatures features = ContactFeatures::vertex_face;
    double gap = 0.0;                      // m; negative: overlap
    double normal_force = 0.0;             // N
    Vec3 tangential_force = Vec3::Zero();  // N on B
    double torsion = 0.0;                  // N m on B about the normal
    Vec3 slip = Vec3::Zero();              // m/s, of B's point relative to A's, across the normal
    State state = State::open;
    Vec3 moment = Vec3::Zero();  // N m on B about the world origin: of both forces, at their points of each step
    static constexpr std::size_t nobody = SIZE_MAX;
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [a, b, point, normal, features, gap, normal_force, tangential_force, torsion, slip, state, moment] = self;
        archive.body_or(nobody, a);
        archive.body(b);
        archive.enumeration(features, ContactFeatures::mesh);
        archive.enumeration(state, State::open);
        archive.keep(point, normal, gap, normal_force, tangential_force, torsion, slip, moment);
    }
};

/// Gravity, wind and the forces at points of a dynamic body: means over the frame.
struct ExternalLoad {
    std::size_t body = 0;
    Vec3 force = Vec3::Zero();   // N
    Vec3 moment = Vec3::Zero();  // N m about the world origin
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [body, force, moment] = self;
        archive.body(body);
        archive.keep(force, moment);
    }
};

/// Energy from the start of the simulation on, J.
struct EnergyLedger {
    double work = 0.0;  // by wind, forces at points, motors and kinematic bodies; gravity's is in the potential energy
    double impact_loss = 0.0;    // by impacts, by landings and at limits of joints
    double friction_loss = 0.0;  // by friction of resting and sliding contacts and in joints
    double motor_work = 0.0;     // the part of `work` by motors of joints
    double joint_heat = 0.0;     // the part of `friction_loss` in joints: friction, dampers, breaking
    double surface = 0.0;        // by impacts, in the new surfaces of bodies that broke
    double water_loss = 0.0;     // taken by water, without the potential of the displaced water
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [work, impact_loss, friction_loss, motor_work, joint_heat, surface, water_loss] = self;
        archive.keep(work, impact_loss, friction_loss, motor_work, joint_heat, surface, water_loss);
    }
};

/// True if the bodies that the impacts struck are among so many.
inline bool names_struck(const std::vector<ImpactRecord>& impacts, std::size_t struck) {
    for (const ImpactRecord& impact : impacts)
        if (impact.struck_a >= struck || impact.struck_b >= struck) return false;
    return true;
}

struct ContactRecords {
    std::vector<ImpactRecord> impacts;    // in order of time
    std::vector<StruckBody> struck;       // one for each impact and body of it
    std::vector<ContactRecord> contacts;  // ascending by bodies
    std::vector<ExternalLoad> loads;      // of all dynamic bodies, ascending
    std::vector<JointState> joints;       // at the end of the frame, in scene order
    EnergyLedger energy;
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [impacts, struck, contacts, loads, joints, energy] = self;
        archive.keep(impacts, struck, contacts, loads, joints, energy);
        archive.require([&] { return names_struck(self.impacts, self.struck.size()); });
    }
};

}  // namespace tumble
