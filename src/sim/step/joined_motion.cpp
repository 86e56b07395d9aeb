#include "sim/step/joined_motion.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/geometry/contact_tolerance.h"
#include "sim/step/placed_bodies.h"

#include <algorithm>

namespace tumble {
namespace {

bool touch(const Manifold& m, const std::vector<Body>& bodies) {
    const double distance = touch_distance(bodies[m.a].radius, bodies[m.b].radius);
    return std::any_of(m.points.begin(), m.points.begin() + m.count,
                       [&](const ContactPoint& p) { return p.separation <= distance; });
}

}  // namespace

bool JoinedMotion::fly(const StepContext& step, ContactDetection& detection, std::size_t island) {
    const ContactIslands& islands = detection.islands();
    const auto bodies = islands.bodies(island);
    std::unique_ptr<IslandFlight>& flight = flights_[bodies[0]];
    if (!flight) flight = std::make_unique<IslandFlight>();
    return flight->fly({step.set.bodies, step.joints, detection.manifolds(), step.forces.field(), bodies,
                        islands.joints(island), islands.manifolds(island), step.start(), step.end()});
}

void JoinedMotion::decide(const StepContext& step, ContactDetection& detection) {
    std::vector<Body>& bodies = step.set.bodies;
    ways_.clear();
    const ContactIslands& islands = detection.islands();
    if (step.joints.empty()) return;
    mechanisms_.find(step.joints, bodies, rule_);
    flights_.resize(bodies.size());
    ways_.resize(islands.size());
    std::vector<ContactFacts> contacts(islands.size());
    std::vector<MechanismFacts> facts(islands.size());
    std::size_t figures = 0;
    for (std::size_t k = 0; k < islands.size(); ++k) {
        if (islands.joints(k).empty()) continue;
        facts[k] = mechanisms_.facts(islands.bodies(k));
        contacts[k].within_reach = !islands.manifolds(k).empty();
        contacts[k].crowd = true;
        if (contacts[k].within_reach && !facts[k].net && choose_way(facts[k], contacts[k]) == JointWay::sweeps)
            figures += facts[k].figures;
    }
    crowd_.count(figures);
    std::vector<std::size_t> free;
    for (std::size_t k = 0; k < islands.size(); ++k) {
        if (islands.joints(k).empty()) continue;
        const auto manifolds = islands.manifolds(k);
        contacts[k].crowd = crowd_.swept();
        contacts[k].touching = std::any_of(manifolds.begin(), manifolds.end(),
                                           [&](std::uint32_t m) { return touch(detection.manifolds()[m], bodies); });
        ways_[k] = {choose_way(facts[k], contacts[k]), facts[k].net, facts[k].entangled};
        if (ways_[k].way == JointWay::free) free.push_back(k);
    }
    std::vector<char> flown(free.size(), 0);
    step.pool.for_each(free.size(), 1, [&](std::size_t n, std::size_t) { flown[n] = fly(step, detection, free[n]); });
    for (std::size_t n = 0; n < free.size(); ++n) {
        const std::size_t k = free[n];
        if (!flown[n]) {
            contacts[k].touching = true;
            ways_[k].way = choose_way(facts[k], contacts[k]);
            continue;
        }
        const std::span<const RigidState> ends = flights_[islands.bodies(k)[0]]->ends();
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const std::uint32_t body = islands.bodies(k)[i];
            if (!bodies[body].jointed) continue;  // moves as if alone
            step.placed.place(body, ends[i], bodies);
        }
        for (const std::uint32_t m : islands.manifolds(k)) {
            release(detection.manifolds()[m]);
            detection.manifolds()[m].solved_by = SolvedBy::flight;
        }
    }
}

}  // namespace tumble
