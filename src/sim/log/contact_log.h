// Collects the impacts, contacts and momentum balance of a frame (sim/snapshot/contact_records.h). The stages of a step
// write into it where it is asked for; nothing of it affects the motion.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/forces.h"
#include "sim/impact/impact_system.h"
#include "sim/snapshot/contact_records.h"

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

namespace tumble {

class ContactLog {
public:
    /// The bodies' indices in the scene, by body; the origin of their coordinates (m, world).
    ContactLog(std::span<const std::uint32_t> scene_index, const Vec3& origin, const Vec3& gravity);

    void begin_frame(const std::vector<Body>& bodies);

    struct ImpactTime {
        double time;  // s
        bool exact;
    };
    /// Adds one impact with the entries of its trace. The momenta are those before or after it; the poses are its own.
    void add_impact(const ImpactTrace& trace, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                    const ImpactTime& when);
    /// The same for one entry, of a contact without friction at a point (m, of the bodies' coordinates).
    void add_entry(const ImpactTrace::Entry& entry, const Contact& contact, const Vec3& point,
                   const std::vector<Body>& bodies, const ImpactTime& when);

    /// Adds the impulses of a solve of resting contact over `h` (s). `totals` by manifold.
    void add_contacts(std::span<const std::uint32_t> manifolds, const ContactProblem& problem,
                      const std::vector<ManifoldImpulse>& totals);

    /// Adds impulses of forces other than gravity.
    void add_external(std::uint32_t body, const Impulse& impulse);

    /// The records of the frame of `duration` (s).
    ContactRecords finish_frame(const std::vector<Body>& bodies, const ForceField& forces, double duration);

private:
    struct Key {
        std::uint32_t a, b, part;
        std::uint64_t feature;
        auto operator<=>(const Key&) const = default;
    };
    struct Sum {
        ContactRecord last;  // place and state at the last step
        double normal = 0.0;
        Vec3 tangential = Vec3::Zero(), moment = Vec3::Zero();  // N s, N m s
        double span = 0.0;                                      // s, with contact
    };
    /// Of a body: impulses of the frame, and its momenta at the start.
    struct Account {
        ImpulseSum start, external, impacts, contacts;
    };
    ContactRecord oriented(ContactRecord record) const;
    bool sleeping(const Key& key, const std::vector<Body>& bodies) const;

    std::vector<std::uint32_t> scene_index_;
    Vec3 origin_, gravity_;
    std::map<Key, Sum> sums_;
    std::map<Key, ContactRecord> asleep_;  // contacts that hold sleeping bodies, with their forces
    std::vector<Account> accounts_;        // by body
    ContactRecords records_;
};

}  // namespace tumble
