// A blow on bodies with bonds: which bonds fail, and how the pieces and the bodies that struck them move then.
//
// The impulses of the blow on the whole bodies, over the time of a blow, load the bonds. Bonds that fail part a body;
// the pieces get the impulses of the same blow without restitution, which load their own bonds, and so on. New surface
// costs energy. With v_r the motion after the blow on the whole bodies, and v_f on the pieces, both without
// restitution, the motion is v_r + s (v_f - v_r): it keeps both momenta, and no contact approaches in it, as in both. s
// follows from the energy: that of v_f less the toughness times the area of the bonds. Bonds for which it does not
// suffice hold.
#pragma once

#include "sim/fracture/breakable_bodies.h"
#include "sim/impact/impacts.h"
#include "sim/snapshot/break_record.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace tumble {

struct BlowResult {
    std::vector<BreakableBody::Parting> partings;  // the bodies that broke, as they moved before the blow
    std::vector<std::uint32_t> struck;             // dynamic bodies of the blow, with the pieces, ascending
    std::vector<BodyVelocity> velocities;          // of these, after the blow
    std::vector<Contact> contacts;                 // with their impulses in the blow; between pieces too
    std::vector<BreakRecord> breaks;               // without their times
    double surface = 0.0;                          // J, of the bonds that failed
};

class Blow {
public:
    /// `contacts`: of the island, at the velocities before the blow. `joints`: of the world.
    Blow(const Island& island, const std::vector<Contact>& contacts, std::vector<Body>& bodies,
         BreakableBodies& breakables, std::vector<Joint>& joints, const ImpactSettings& settings);

    /// Returns whether anything breaks. Then the pieces have the motion of their wholes before the blow, and nothing
    /// else is changed.
    bool resolve();
    const BlowResult& result() const { return result_; }

private:
    struct Side {  // of a contact, on a breakable body
        std::uint32_t entry = BreakableBodies::none, cell = 0;
        Vec3 point = Vec3::Zero();  // m, body frame, from the body's origin
    };
    struct Failing {
        std::uint32_t entry, bond;
        Wrench wrench;  // N, N m
    };
    struct Target {  // a body that may break in this blow
        std::uint32_t entry;
        BreakableBody before;
        std::vector<std::pair<std::uint32_t, Body>> saved;  // its bodies
        BondGraph graph;                                    // without the bonds that failed so far
    };
    struct Trial {  // the bodies as the bonds that failed so far part them
        Island island;
        std::vector<Contact> contacts;
        std::vector<Side> sides_a, sides_b;
        std::vector<BreakableBody::Parting> partings;
        std::vector<BodyVelocity> start, rigid, free;  // of the island's bodies
    };

    void find_sides();
    void add_target(std::uint32_t entry);
    Target* target(std::uint32_t entry);
    const Body& body_before(const Target& target, std::uint32_t cell) const;
    bool resolve_impact(const Island& island, std::vector<Contact>& contacts, const ImpactSettings& settings);
    std::vector<BodyVelocity> velocities(const Island& island) const;
    void set_velocities(const Island& island, const std::vector<BodyVelocity>& velocities);
    std::vector<Failing> failing(const std::vector<Contact>& contacts, const std::vector<Side>& a,
                                 const std::vector<Side>& b);
    void cut(const std::vector<Failing>& failing);
    void put_back();
    Trial part(const std::vector<BodyVelocity>& rigid);
    void set_contacts(Trial& trial) const;
    double product(const Island& island, const std::vector<BodyVelocity>& l, const std::vector<BodyVelocity>& r) const;
    /// `stopped`: the contacts on the wholes, with the impulses that stop them.
    void finish(Trial& trial, const std::vector<Contact>& stopped);

    const Island& island_;
    std::vector<Contact> contacts_;  // without impulses
    std::vector<Body>& bodies_;
    BreakableBodies& breakables_;
    std::vector<Joint>& joints_;
    ImpactSettings settings_;
    std::vector<Side> sides_a_, sides_b_;  // by contact
    std::vector<Target> targets_;
    std::vector<BodyVelocity> start_;  // of the island's bodies
    std::vector<Failing> cut_;         // bonds that failed so far
    double surface_ = 0.0;             // J, of these
    BlowResult result_;
};

}  // namespace tumble
