// Friction within an impact: Coulomb's law for impulses, at the moment of the collision.
//
// Each contact's friction impulse f lies across its normal within the disc |f| <= mu j of its normal impulse j. All f
// together are those that leave the least kinetic energy: at each contact the slip that is left is then zero, or f is at
// the disc's edge and opposes the slip. Block coordinate descent, contact by contact, each minimised exactly over its
// disc; no step of it can gain energy, which Newton's restitution with a friction that follows the slip before the impact
// can (Kane and Levinson 1985, "Dynamics", the double pendulum; Stronge 1990, "Rigid body collisions with friction").
#pragma once

#include "sim/contact/contact_cluster.h"

#include <vector>

namespace tumble {

class ImpactFriction {
public:
    explicit ImpactFriction(const ContactCluster& cluster) : has_block_(cluster.size(), 0) {}

    /// Brings the friction impulses up to the cluster's present normal impulses and velocities. False when next to nothing
    /// changed.
    bool apply(ContactCluster& cluster);

    /// Writes the impulses to the contacts, N s on B.
    void store(const ContactCluster& cluster, std::vector<Contact>& contacts) const;

private:
    double tolerance() const;
    struct Block {
        std::size_t contact;             // of the cluster
        Vec3 first, second;              // principal directions of the compliance across the normal
        VelocityRow first_row, second_row;
        double first_offset, second_offset;       // m/s
        double first_compliance, second_compliance;   // 1/kg
        double f0 = 0.0, f1 = 0.0;       // N s along the two
    };

    static Block make_block(const ContactCluster& cluster, std::size_t contact);
    void add_blocks(const ContactCluster& cluster);
    double relax(ContactCluster& cluster, Block& block) const;

    std::vector<char> has_block_;           // by contact of the cluster
    std::vector<Block> blocks_;             // of the contacts that have had a normal impulse, ascending
};

}  // namespace tumble
