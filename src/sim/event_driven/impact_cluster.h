// Impact cluster: the contacts that are resolved together in one impact of two bodies. It grows only as far as the
// impulse reaches: a body's own contacts join when it gets an impulse, or when it has an impact of its own at this very
// time: sixteen balls that reach the ground under a plate do so together, not one after another. A group of joined
// bodies takes part as a whole.
#pragma once

#include "sim/event_driven/contact_transition.h"
#include "sim/event_driven/group_flights.h"
#include "sim/event_driven/neighbor_boxes.h"
#include "sim/geometry/collide.h"
#include "sim/impact/impacts.h"

#include <functional>
#include <optional>
#include <vector>

namespace tumble {

class ImpactCluster {
public:
    /// A ball that holds a body's center at the time of the impact.
    struct Whereabouts {
        Vec3 center = Vec3::Zero();  // m
        double radius = 0.0;         // m
    };
    struct Bring {
        /// Moves a body's state to the time of the impact.
        std::function<void(std::uint32_t)> state;
        /// Where a body is whose state is expensive to find; none for others.
        std::function<std::optional<Whereabouts>(std::uint32_t)> roughly;

        void operator()(std::uint32_t body) const { state(body); }
    };

    /// `groups`: of joined bodies. It must outlive the cluster.
    explicit ImpactCluster(GroupFlights& groups) : groups_(groups) { scratch_.choice = AxisChoice::nearest; }

    /// Resolves a blow on the contacts of a cluster that breaks a body; returns whether one broke.
    using Strike = std::function<bool(const Island&, const std::vector<Contact>&, const ImpactSettings&)>;
    /// Load speed of a contact, m/s.
    using LoadSpeed = std::function<double(const Contact&, const Gap&)>;

    /// Resolves the impact of bodies `a` and `b` and its cluster; momenta and velocities are changed in place. Returns
    /// whether anything changed. Joints whose strength the impact exceeds break (joint_strength.h). `trace`: gets the
    /// impulses on contacts(), or null. `load`: null where contacts have none. `strike`: null without breakable bodies;
    /// where it breaks one, the cluster leaves the impact to it, and broke() is true.
    bool resolve(std::uint32_t a, std::uint32_t b, std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes,
                 const Bring& bring, const LoadSpeed& load, const ImpactSettings& settings,
                 ImpactTrace* trace = nullptr, const Strike& strike = nullptr);
    bool broke() const { return broke_; }

    /// Results of the last call: the contacts examined, and the dynamic bodies that got an impulse, ascending.
    const std::vector<Contact>& contacts() const { return contacts_; }
    const std::vector<Gap>& gaps() const { return gaps_; }  // by contact
    const std::vector<Manifold>& manifolds() const { return manifolds_; }
    const std::vector<std::uint32_t>& impulse_receivers() const { return receivers_; }
    const std::vector<JointImpulse>& joint_impulses() const { return joint_impulses_; }
    /// Joints that broke.
    const std::vector<Joint*>& broken() const { return broken_; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [groups, brought, expanded, examined, receivers, pairs, manifolds, contacts, gaps, own, before, reach,
               scratch, widening, broken, joint_impulses, broke] = self;
        archive.rebuilt(groups);
        archive.keep(scratch, widening);
        archive.scratch(brought, expanded, examined, receivers, pairs, manifolds, contacts, gaps, own, before, reach,
                        broken, joint_impulses, broke);
    }

private:
    void expand(std::uint32_t body, std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes, const Bring& bring);
    void note_reach(const std::vector<Body>& bodies);
    bool grow(std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes, const Bring& bring);
    bool approaches(std::uint32_t body, std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes,
                    const Bring& bring);
    void touch(std::uint32_t i, std::uint32_t j, std::vector<Body>& bodies, const Bring& bring);

    void expand_body(std::uint32_t body, std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes,
                     const Bring& bring);
    Island island(std::vector<Body>& bodies, const Bring& bring);
    void resolve_island(Island& island, std::vector<Body>& bodies, const ImpactSettings& settings, ImpactTrace* trace);

    GroupFlights& groups_;
    std::vector<std::uint32_t> brought_, expanded_, examined_, receivers_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
    std::vector<Manifold> manifolds_;
    enum class Reach : char { none, motion, impulse };  // effect of an impact on the two bodies of a contact
    std::vector<Contact> contacts_;
    std::vector<Gap> gaps_;
    std::vector<Contact> own_;
    std::vector<double> before_;  // by contact: v_rel before the impact
    std::vector<Reach> reach_;    // by contact
    CollisionScratch scratch_;
    double widening_ = 1.0;
    std::vector<Joint*> broken_;
    std::vector<JointImpulse> joint_impulses_;  // of the last resolution
    bool broke_ = false;
};

}  // namespace tumble
