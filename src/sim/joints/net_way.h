// Nets: groups of joined bodies whose joints are so entangled that a direct solution is dear. They are solved in sweeps
// (sim/contact/soft), together with all that they touch, if their joints are such as the sweeps know.
#pragma once

#include "sim/joints/joint.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class JointSet;
struct JointGroup;

/// Whether sweeps know the joint: it holds two anchors together and locks or limits turns, with dampers or friction of
/// turns, or it holds their distance. Springs, motors, strengths, gears, sliding joints and restitution at limits are
/// left to the direct solver.
bool known_to_sweeps(const Joint& joint);

/// Block products of a factorization per body of the group, without contacts.
double factor_work(const JointGroup& group, const JointSet& joints);

/// Groups that are solved in sweeps, of those whose joints sweeps know: none, those that are dear to factor, or all.
enum class NetRule : std::uint8_t { none, dear, all };

/// Whether a group of joined bodies is solved in sweeps.
bool is_net(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies, NetRule rule);

/// The nets of a world, found anew when joints begin or end to hold.
class Nets {
public:
    void find(const JointSet& joints, const std::vector<Body>& bodies, NetRule rule);
    /// Whether joined bodies are solved in sweeps: some belong to a net, and none has a joint, or an integrator, that
    /// sweeps do not know.
    enum class Way : std::uint8_t { direct, sweeps, mixed };
    Way way(std::span<const std::uint32_t> bodies) const;
    /// Whether a net among the bodies has more joints than bodies: errors then take many sweeps to spread.
    bool entangled(std::span<const std::uint32_t> bodies) const;

private:
    enum class Role : std::uint8_t { plain, loose, entangled, unknown };
    std::vector<Role> role_;                   // by body
    std::uint64_t found_ = ~std::uint64_t(0);  // JointSet::changes() of the roles
};

}  // namespace tumble
