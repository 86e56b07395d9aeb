// All that touches where two bodies meet: the contacts that take part in one impact, resolved together. The cluster grows
// only as far as the blow reaches: a body's own contacts join when an impulse has come to it.
#pragma once

#include "sim/collision/collide.h"
#include "sim/contact/impacts.h"
#include "sim/flight/neighbourhood.h"

#include <functional>
#include <vector>

namespace tumble {

class ImpactCluster {
public:
    ImpactCluster() { scratch_.choice = AxisChoice::nearest; }

    /// Brings a body's state to the moment of the impact.
    using Bring = std::function<void(std::uint32_t)>;

    /// Resolves the impact of bodies `a` and `b` and all that hangs on it; momenta and velocities are changed in place.
    /// Returns whether anything did change.
    bool resolve(std::uint32_t a, std::uint32_t b, std::vector<Body>& bodies, const Neighbourhood& neighbourhood,
                 const Bring& bring, const ImpactSettings& settings);

    /// Of the last call: the contacts that were looked at, and the dynamic bodies that got an impulse, ascending.
    const std::vector<Contact>& contacts() const { return contacts_; }
    const std::vector<Manifold>& manifolds() const { return manifolds_; }
    const std::vector<std::uint32_t>& struck() const { return struck_; }

private:
    void expand(std::uint32_t body, std::vector<Body>& bodies, const Neighbourhood& neighbourhood, const Bring& bring);
    void touch(std::uint32_t i, std::uint32_t j, std::vector<Body>& bodies, const Bring& bring);

    std::vector<std::uint32_t> brought_, expanded_, struck_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
    std::vector<Manifold> manifolds_;
    std::vector<Contact> contacts_;
    CollisionScratch scratch_;
    double widening_ = 1.0;
};

}  // namespace tumble
