// Impacts of a step: contacts with restitution whose points approach are resolved with all contacts of their islands
// (notes eq. 20), before the step's forces.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/geometry/manifold.h"
#include "sim/impact/impacts.h"

#include <cstdint>
#include <vector>

namespace tumble {

class ContactDetection;
class ContactIslands;
class JointSet;
struct StepContext;

/// An island of the step's contacts with its joints, without contacts.
Island island_of(std::size_t island, const ContactIslands& islands, JointSet& joints);

class ImpactStage {
public:
    /// v_rel < 0: impulses with restitution.
    void resolve(const StepContext& step, ContactDetection& detection);
    /// True if the step has impacts: momenta have changed.
    bool any() const { return !struck_.empty(); }

    /// Restores the speeds of the bounces after the step's forces.
    void hold_bounces(const StepContext& step);

    /// After the contacts are solved: an impulse that stopped an impact in this step is a bad initial guess for the
    /// next. A contact may keep at most twice its last value, or twice the lighter body's load, its weight or more.
    void limit_warm_start(const StepContext& step, ContactDetection& detection) const;

    static ImpactSettings settings(const StepContext& step);
    /// Approach speed (m/s) below which a contact does not bounce.
    static double threshold(const StepContext& step);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [contacts, colliding, struck, traces, joint_impulses] = self;
        archive.scratch(contacts, colliding, struck, traces, joint_impulses);
    }

private:
    struct Struck {
        std::uint32_t manifold = 0;
        double impulse_before = 0.0, load_speed = 0.0;  // N s, before the step; m/s, the largest of its points
    };
    void add_island(std::size_t island, const StepContext& step, ContactDetection& detection);
    bool spread_load(std::size_t first_contact, std::size_t first_struck, const StepContext& step);
    void add_contacts_under_load(const Manifold& manifold, const StepContext& step, Struck& struck);
    void resolve_island(const StepContext& step, std::size_t island);

    std::vector<Contact> contacts_;                          // of the colliding islands, point by point
    std::vector<Island> colliding_;                          // islands with impacts in this step
    std::vector<Struck> struck_;                             // manifolds of these islands
    std::vector<ImpactTrace> traces_;                        // by entry of colliding_; for the log
    std::vector<std::vector<JointImpulse>> joint_impulses_;  // by entry of colliding_
};

}  // namespace tumble
