// Friction within an impact: Coulomb's law for impulses, at the moment of the collision.
//
// Each contact's friction impulse f lies across its normal within the disc |f| <= mu j of its normal impulse j: the slip that is
// left is zero, or f is at the disc's edge and opposes it. Where friction turns a body it changes v_rel as well. The normal
// impulses change with it, so that v_rel stays what the impact law without friction made of it: -e v_rel of before, where it is the
// only contact. A rod that lands on its end and does not slip comes back at e times the speed, by every law there is (Newton's,
// Poisson's, Stronge's). Found by relaxing contact after contact, v_rel first, then f over its disc.
//
// Newton's restitution with Coulomb's friction can gain energy (Kane and Levinson 1985, "Dynamics", the double pendulum; Stronge
// 1990, "Rigid body collisions with friction"). Friction must not: where it would leave more than there was without, the impulses
// lie on the way from those that leave the least energy with the normal impulses as they were, as far as they leave no more.
#pragma once

#include "sim/impact/impact_system.h"

#include <array>
#include <vector>

namespace tumble {

class ImpactFriction {
public:
    enum class Precision { last_digits, step };   // for an impact at its own time, or at a step

    ImpactFriction(const ImpactSystem& cluster, Precision precision) : precision_(precision), has_block_(cluster.size(), 0) {}

    /// Brings the friction impulses up to the cluster's present normal impulses and velocities. False when next to nothing
    /// changed.
    bool apply(ImpactSystem& cluster);

    /// Writes the impulses to the contacts, N s on B.
    void store(const ImpactSystem& cluster, std::vector<Contact>& contacts) const;

private:
    // What a block's three impulses are (N s: normal, f0, f1) and what its contact does (m/s: v_rel, slip along the two).
    struct State {
        std::array<double, 3> impulse, speed;
    };
    enum class Normal { fixed, adapted };   // impulses

    struct Block {
        std::size_t contact;             // of the cluster
        Vec3 first, second;              // principal directions of the compliance across the normal
        VelocityRow first_row, second_row;
        double first_offset, second_offset;       // m/s
        double first_compliance, second_compliance, normal_first, normal_second;   // 1/kg, the last two between normal and tangents
        double f0 = 0.0, f1 = 0.0;       // N s along the two
        double kept = 0.0;               // m/s: v_rel before friction
    };

    static Block make_block(const ImpactSystem& cluster, std::size_t contact);
    void add_blocks(const ImpactSystem& cluster);
    double relax(ImpactSystem& cluster, Block& block, Normal normal) const;
    double relax_all(ImpactSystem& cluster, Normal normal);
    double tolerance() const;
    static State state(const ImpactSystem& cluster, const Block& block);
    void look(const ImpactSystem& cluster, std::vector<State>& states) const;
    void set(ImpactSystem& cluster, const std::vector<State>& from, const std::vector<State>& to, double share);
    void limit_energy(ImpactSystem& cluster);

    Precision precision_;
    std::vector<char> has_block_;           // by contact of the cluster
    std::vector<Block> blocks_;             // of the contacts that have had a normal impulse, ascending
    std::vector<State> start_, kept_, least_;   // by block: before friction, with v_rel kept, with the least energy
};

}  // namespace tumble
