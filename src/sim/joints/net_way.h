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

/// Whether sweeps know the joint: it holds two anchors together, or their distance, and nothing else.
bool known_to_sweeps(const Joint& joint);

/// Block products of a factorization per body of the group, without contacts.
double factor_work(const JointGroup& group, const JointSet& joints);

/// Whether a group of joined bodies is a net.
bool is_net(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies);

/// The nets of a world, found anew when joints begin or end to hold.
class Nets {
public:
    /// `every`: each group counts as a net.
    void find(const JointSet& joints, const std::vector<Body>& bodies, bool every);
    /// Whether joined bodies are solved in sweeps: some belong to a net, and none has a joint, or an integrator, that
    /// sweeps do not know.
    enum class Way : std::uint8_t { direct, sweeps, mixed };
    Way way(std::span<const std::uint32_t> bodies) const;

private:
    enum class Role : std::uint8_t { plain, net, unknown };
    std::vector<Role> role_;                   // by body
    std::uint64_t found_ = ~std::uint64_t(0);  // JointSet::changes() of the roles
};

}  // namespace tumble
