// Friction within an impact: Coulomb's law for impulses, at the time of the impact.
//
// Each contact's friction impulse f lies across its normal within the disc |f| <= mu j of its normal impulse j: either
// the remaining slip is zero, or f is at the disc's edge and opposes it. Where friction rotates a body it changes v_rel
// as well. The normal impulses change with it, so that v_rel keeps the value that the impact law without friction gave
// it: -e times the v_rel before the impact, for a single contact. A rod that lands on its end and does not slip
// rebounds at e times the speed, by every law there is (Newton's, Poisson's, Stronge's). Solved by relaxing the
// contacts, v_rel first, then f over its disc: all at once, or one after the other in large impacts.
//
// Newton's restitution with Coulomb's friction can gain energy (Kane and Levinson 1985, "Dynamics", the double
// pendulum; Stronge 1990, "Rigid body collisions with friction"). Friction must not: where the energy would exceed that
// without friction, the impulses are interpolated towards those that leave the least energy with unchanged normal
// impulses, until it does not.
#pragma once

#include "sim/impact/impact_system.h"

#include <array>
#include <vector>

namespace tumble {

class ImpactFriction {
public:
    enum class Precision { last_digits, step };  // for an impact at its own time, or at a step

    ImpactFriction(const ImpactSystem& cluster, Precision precision)
        : precision_(precision), has_block_(cluster.size(), 0) {}

    /// Updates the friction impulses for the cluster's present normal impulses and velocities. Returns false when the
    /// change is negligible.
    bool apply(ImpactSystem& cluster);

    /// Writes the impulses to the contacts, N s on B.
    void store(const ImpactSystem& cluster, std::vector<Contact>& contacts) const;

private:
    // A block's three impulses (N s: normal, f0, f1) and its contact's speeds (m/s: v_rel, slip along the two).
    struct State {
        std::array<double, 3> impulse, speed;
    };
    enum class Normal { fixed, adapted };  // impulses

    struct Block {
        std::size_t contact;  // index in the cluster
        Vec3 first, second;   // unit, world: principal directions of the compliance across the normal
        VelocityRow first_row, second_row;
        double first_offset, second_offset;  // m/s
        // 1/kg, the last two couple the normal with the tangents
        double first_compliance, second_compliance, normal_first, normal_second;
        double f0 = 0.0, f1 = 0.0;  // N s along the two
        double kept = 0.0;          // m/s: v_rel before friction
        double limit = 0.0;         // N s, where limits are held
    };

    static Block make_block(ImpactSystem& cluster, std::size_t contact);
    void add_blocks(ImpactSystem& cluster);
    struct Step {  // N s: normal, along the two; and the change of speed, m/s
        double normal = 0.0, f0 = 0.0, f1 = 0.0, change = 0.0;
    };
    double limit(const ImpactSystem& cluster, const Block& block, double added) const;
    void hold_limits(const ImpactSystem& cluster);
    void let_limits_go(ImpactSystem& cluster);
    Step relaxed(const ImpactSystem& cluster, const Block& block, Normal normal, double crowd) const;
    static void take(ImpactSystem& cluster, Block& block, const Step& step);
    void find_crowds(const ImpactSystem& cluster);
    double relax_at_once(ImpactSystem& cluster, Normal normal);
    double relax_all(ImpactSystem& cluster, Normal normal);
    double tolerance() const;
    int most_sweeps() const;
    static State state(const ImpactSystem& cluster, const Block& block);
    void collect(const ImpactSystem& cluster, std::vector<State>& states) const;
    void set(ImpactSystem& cluster, const std::vector<State>& from, const std::vector<State>& to, double share);
    void limit_energy(ImpactSystem& cluster);

    Precision precision_;
    bool limits_held_ = false;                 // friction's limits no longer follow the normal impulses
    std::vector<char> has_block_;              // by contact of the cluster
    std::vector<Block> blocks_;                // of the contacts that have had a normal impulse, ascending
    std::vector<Step> steps_, moved_;          // by block: of a sweep, and since the sweep before
    std::vector<double> crowds_;               // by block
    std::vector<State> start_, kept_, least_;  // by block: before friction, with v_rel kept, with the least energy
};

}  // namespace tumble
