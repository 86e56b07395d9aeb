// Converts values of the interface to values of the layers below, and back; to the bit.
#pragma once

#include "core/error.h"
#include "core/image.h"
#include "core/vector.h"
#include "sim/snapshot/break_record.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/joint_state.h"
#include "sim/snapshot/report.h"
#include "sim/snapshot/snapshot.h"
#include "tumble/contacts.h"
#include "tumble/image.h"
#include "tumble/joints.h"
#include "tumble/snapshot.h"
#include "tumble/vector.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace tumble::v0 {

inline tumble::Vec3 to_internal(const Vec3& v) { return {v.x, v.y, v.z}; }
inline tumble::Quat to_internal(const Quat& q) { return {q.w, q.x, q.y, q.z}; }
inline Vec3 to_public(const tumble::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat to_public(const tumble::Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

inline Snapshot to_public(const tumble::Snapshot& from) {
    Snapshot to{from.frame, from.time, {}};
    to.bodies.reserve(from.bodies.size());
    for (const tumble::BodyState& b : from.bodies)
        to.bodies.push_back({to_public(b.origin), to_public(b.center_of_mass), to_public(b.orientation),
                             to_public(b.velocity), to_public(b.angular_velocity), b.absent});
    return to;
}

inline FrameContacts to_public(const ContactRecords& from) {
    FrameContacts to;
    for (const ImpactRecord& r : from.impacts)
        to.impacts.push_back({r.when.time, r.when.exact, r.when.frame, r.a, r.b, to_public(r.point),
                              to_public(r.normal), ContactFeatures(r.features), r.speed_before, r.speed_after,
                              r.restitution, r.impulse, to_public(r.friction), r.pass, to_public(r.moment)});
    for (const ContactRecord& r : from.contacts)
        to.contacts.push_back({r.a, r.b, to_public(r.point), to_public(r.normal), ContactFeatures(r.features), r.gap,
                               r.normal_force, to_public(r.tangential_force), r.torsion, to_public(r.slip),
                               Contact::State(r.state), to_public(r.moment)});
    for (const tumble::ExternalLoad& r : from.loads)
        to.loads.push_back({r.body, to_public(r.force), to_public(r.moment)});
    return to;
}

inline std::vector<JointState> to_public(const std::vector<tumble::JointState>& from) {
    std::vector<JointState> to;
    to.reserve(from.size());
    for (const tumble::JointState& j : from)
        to.push_back({to_public(j.point), j.free, j.position, j.speed, to_public(j.mean_force),
                      to_public(j.mean_torque), to_public(j.mean_moment), j.gap, j.limit, j.active, j.broken_at});
    return to;
}

inline std::vector<Break> to_public(const std::vector<BreakRecord>& from) {
    std::vector<Break> to;
    for (const BreakRecord& r : from)
        to.push_back({r.time, r.body, r.bond, r.area, r.tension, r.bending, r.shear, r.torsion, r.energy, r.pieces});
    return to;
}

inline Energies to_public(const Measurement& m, const EnergyLedger& ledger) {
    return {.kinetic = m.kinetic,
            .potential = m.potential,
            .momentum = to_public(m.momentum),
            .angular_momentum = to_public(m.angular_momentum),
            .contacts = m.contacts,
            .max_penetration = m.max_penetration,
            .kinetic_linear = m.kinetic_linear,
            .kinetic_angular = m.kinetic_angular,
            .work = ledger.work,
            .impact_loss = ledger.impact_loss,
            .friction_loss = ledger.friction_loss,
            .elastic = m.elastic,
            .motor_work = ledger.motor_work,
            .joint_heat = ledger.joint_heat,
            .surface = ledger.surface,
            .water_loss = ledger.water_loss};
}

/// Throws InputError where the snapshot is not of a scene with that many bodies.
inline tumble::Snapshot to_internal(const Snapshot& from, std::size_t bodies) {
    if (from.bodies.size() != bodies)
        throw InputError(
            fmt::format("the snapshot must hold each body of the scene: {} (given {})", bodies, from.bodies.size()));
    tumble::Snapshot to{from.frame, from.time, {}};
    to.bodies.reserve(bodies);
    for (const BodyState& b : from.bodies) {
        to.bodies.push_back({to_internal(b.origin), to_internal(b.center_of_mass), to_internal(b.orientation),
                             to_internal(b.velocity), to_internal(b.angular_velocity)});
        to.bodies.back().absent = b.absent;
    }
    return to;
}

/// The pixels change hands; nothing is copied.
inline tumble::Image take(Image&& from) {
    tumble::Image to;
    to.width = std::exchange(from.width, 0);
    to.height = std::exchange(from.height, 0);
    to.pixels = std::move(from.pixels);
    return to;
}
inline Image take(tumble::Image&& from) { return {from.width, from.height, std::move(from.pixels)}; }

/// A copy. Throws InputError where the number of pixels does not fit the size.
inline tumble::Image to_internal(const Image& from) {
    if (from.width < 1 || from.height < 1 ||
        from.pixels.size() != std::size_t(from.width) * std::size_t(from.height) * 4)
        throw InputError(fmt::format("an image must have width * height * 4 bytes (given {} x {} pixels with {} bytes)",
                                     from.width, from.height, from.pixels.size()));
    return take(Image(from));
}

}  // namespace tumble::v0
