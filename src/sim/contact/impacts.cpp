#include "sim/contact/impacts.h"

#include <algorithm>

namespace tumble {
namespace {

// Most steps of most islands hold no impact: that is told apart from the contacts as they are.
bool may_collide(const Island& island, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                 const ImpactSettings& settings) {
    for (const std::uint32_t k : island.contacts) {
        const Contact& c = contacts[k];
        if (!c.touching()) continue;
        const double u = relative_velocity(c, bodies[c.a], bodies[c.b]);
        if (settings.complete ? u < 0.0 : u < -settings.threshold && c.restitution > 0.0) return true;
    }
    return false;
}

int resolve_normally(ContactCluster& cluster, const ImpactSettings& settings) {
    int passes = settings.law == ImpactLaw::propagating ? propagate(cluster, settings.threshold)
                                                        : resolve_together(cluster, settings.threshold);
    if (!settings.complete) return passes;
    for (std::size_t i = 0; i < cluster.size(); ++i) {
        if (!cluster.approaching(i)) continue;
        stop(cluster);
        return passes + 1;
    }
    return passes;
}

}  // namespace

int resolve_impacts(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                    const ImpactSettings& settings) {
    if (!may_collide(island, contacts, bodies, settings)) return 0;
    ContactCluster cluster(island, contacts, bodies);
    const int passes = resolve_normally(cluster, settings);
    if (passes > 0) cluster.store(contacts, bodies);
    return passes;
}

}  // namespace tumble
