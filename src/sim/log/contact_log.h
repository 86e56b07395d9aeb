// Collects the impacts, contacts and energy losses of a frame (sim/snapshot/contact_records.h). The stages of a step
// write into it where it is asked for; nothing of it affects the motion.
//
// Over a frame the change of a body's momentum, and of its angular momentum about the world origin, is the sum of its
// impact records, and of its contact records and its load times the frame's duration. Corrections of the method (bodies
// stopped by CCD, the energy budget of the soft solver, bounces held through a step, displacements without momentum)
// have records of their own, without a body A.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/forces.h"
#include "sim/impact/impact_system.h"
#include "sim/snapshot/contact_records.h"

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace tumble {

struct RolledContact;

class ContactLog {
public:
    /// energy: only the ledger of the records is kept; their lists stay empty.
    enum class Detail { energy, records };

    /// The bodies' indices in the scene, by body; the origin of their coordinates (m, world); gravity, m/s^2.
    ContactLog(std::span<const std::uint32_t> scene_index, const Vec3& origin, const Vec3& gravity, Detail detail);

    bool has_records() const { return detail_ == Detail::records; }

    void begin_frame(const std::vector<Body>& bodies);

    /// Adds one impact with the entries of its trace, at the bodies' poses of the impact. Their velocities are those
    /// after it; `joint_impulses`: the impulses of joints.
    void add_impact(const ImpactTrace& trace, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                    const ImpactTime& when, std::span<const JointImpulse> joint_impulses = {});
    /// The same for an impact of one entry without friction, at a point (m) in the bodies' coordinates.
    void add_entry(const ImpactTrace::Entry& entry, const Contact& contact, const Vec3& point,
                   const std::vector<Body>& bodies, const ImpactTime& when);
    /// The same for bodies that were not brought to the impact: their motions then, in the bodies' coordinates.
    void add_entry(const ImpactTrace::Entry& entry, const Contact& contact, const Vec3& point,
                   const std::vector<Body>& bodies, const ImpactTime& when, const StruckBody& a, const StruckBody& b);

    /// Adds the impulses of a solve of resting contact. `totals` by manifold of the problem.
    void add_contacts(std::span<const std::uint32_t> manifolds, const ContactProblem& problem,
                      const std::vector<ManifoldImpulse>& totals);

    /// Adds the contact of a body that rolled through `span` s.
    void add_rolled(const RolledContact& rolled, const std::vector<Manifold>& manifolds,
                    const std::vector<Body>& bodies, double span);

    /// Adds the impulse of a joint in this frame on body B (N s, N m s about the origin of the bodies' coordinates) and
    /// its work on each body, J. `nobody`: the world.
    void add_joint(std::uint32_t a, std::uint32_t b, const Impulse& on_b, double work_a, double work_b);
    static constexpr std::uint32_t nobody = UINT32_MAX;

    /// The pieces of a body take over its momenta and its energy; all move as it did. Its losses of this frame remain.
    /// Pieces of a body that was not dynamic bring their energy as work.
    void hand_over(std::uint32_t whole, bool was_dynamic, std::span<const std::uint32_t> pieces,
                   const std::vector<Body>& bodies);
    /// Adds the energy (J) that new surfaces took from the bodies of an impact.
    void add_surface(double energy, std::span<const std::uint32_t> struck);

    /// Adds gravity's impulse over `span` s on a body whose center is at `place` (m).
    void add_gravity(std::uint32_t index, const Body& body, double span, const Vec3& place);
    /// Adds the impulse of other forces; `mean`: the mean of the velocities before and after it.
    void add_external(std::uint32_t index, const Impulse& impulse, const Vec3& place, const BodyVelocity& mean);
    /// Between these calls nothing but external forces changes the body's momenta: their change is the forces' impulse.
    /// `end_flight` may be called repeatedly. `driven`: by forces other than gravity, whose work is then added.
    void add_work(std::uint32_t index, double work) { accounts_[index].work += work; }  // J, of external forces
    /// The part of such work by water, J.
    void add_water_work(std::uint32_t index, double work) { accounts_[index].water += work; }
    void start_flight(std::uint32_t index, const Body& body);
    void end_flight(std::uint32_t index, const Body& body, bool driven);
    /// The same for the momentum (kg m/s) at a position (m), of a body under gravity alone.
    void start_flight(std::uint32_t index, const Body& body, const Vec3& place, const Vec3& momentum);
    void end_flight(std::uint32_t index, const Body& body, const Vec3& place, const Vec3& momentum);

    /// The records of the frame that ends now and lasted `duration` s (0 for the first frame). `touching`: the
    /// manifolds of the present poses; without records none are needed.
    ContactRecords finish_frame(const std::vector<Body>& bodies, const ForceField& forces,
                                const std::vector<Manifold>& touching, double duration);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [detail, scene_index, origin, gravity, sums, asleep, accounts, struck, friction, handed_over, surface,
               records] = self;
        archive.rebuilt(detail, scene_index, origin, gravity, struck);
        archive.keep(asleep, records.energy);
        archive.scratch(sums, accounts, friction, handed_over, surface);
    }

private:
    struct Key {
        std::uint32_t a, b, part;
        std::uint64_t feature;
        auto operator<=>(const Key&) const = default;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [a, b, part, feature] = self;
            archive.body(a, b);
            archive.any(part, feature);
        }
    };
    struct Sum {
        ContactRecord last;        // position and features at the last step
        Impulse impulse;           // on B, about the world origin
        double torsion = 0.0;      // N m s
        double span = 0.0;         // s, with contact
        double stick_speed = 0.0;  // m/s: slower counts as sticking
    };
    /// Account of a body, in this frame; moments are about the world origin.
    struct Account {
        Impulse start;               // momentum and angular momentum at the start
        Impulse external, contact;   // impulses since then
        double moments = 0.0;        // N m s, sum of the magnitudes of all moments
        Impulse flight;              // momentum and angular momentum at the start of a flight
        double flight_energy = 0.0;  // J, then
        double energy = 0.0;         // J, at the start
        double work = 0.0;           // J, from outside
        double joints = 0.0;         // J, work of joints
        double water = 0.0;          // J, the part of `work` by water
        bool touched = false;        // by an impact or a contact
    };
    void add_record(const ImpactTrace::Entry& entry, const Contact& contact, const Vec3& point,
                    const std::vector<Body>& bodies, const ImpactTime& when);
    void add_struck(const ImpactTrace& trace, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                    std::span<const JointImpulse> joint_impulses);
    /// Marks the bodies of an impact of impulse `j` (N s on B) as touched, and adds its work.
    void add_struck_work(const Contact& contact, const Vec3& j, const std::vector<Body>& bodies);
    Impulse momenta(const Body& body, const Vec3& place, const Vec3& momentum) const;
    Impulse momenta(const Body& body) const { return momenta(body, body.position, body.momentum); }
    static void add_load(Account& account, const Impulse& impulse);
    /// Adds an impulse on B, and the opposite one on A.
    void add_contact(std::uint32_t a, std::uint32_t b, const Impulse& on_b);
    static Key key_of(const Manifold& m, int i) { return {m.a, m.b, m.part, m.points[std::size_t(i)].feature}; }
    double energy(const Body& body) const;
    /// Bodies, position, normal, gap, features and slip of a manifold's point.
    void set_place(ContactRecord& record, const Manifold& m, int i, const std::vector<Body>& bodies) const;
    bool at_rest(const Key& key, const std::vector<Body>& bodies) const;
    void add_touching(const std::vector<Manifold>& touching, const std::vector<Body>& bodies);
    ContactRecord mean(const Key& key, Sum& sum, const std::vector<Body>& bodies, double duration);
    void add_corrections(const std::vector<Body>& bodies, double duration);
    void add_loads(const std::vector<Body>& bodies, double duration);
    void add_losses(const std::vector<Body>& bodies);
    void name_by_scene();

    Detail detail_;
    std::vector<std::uint32_t> scene_index_;
    Vec3 origin_, gravity_;
    std::map<Key, Sum> sums_;
    std::map<Key, ContactRecord> asleep_;  // contacts that hold sleeping bodies, with their forces
    std::vector<Account> accounts_;        // by body
    std::vector<std::size_t> struck_;      // by body: its entry in the records, of the impact that is added
    double friction_ = 0.0;                // J, lost in this frame
    double handed_over_ = 0.0;             // J, lost in this frame by bodies that have broken since
    double surface_ = 0.0;                 // J, in surfaces of this frame
    ContactRecords records_;
};

}  // namespace tumble
