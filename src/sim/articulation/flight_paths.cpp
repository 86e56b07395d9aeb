#include "sim/articulation/flight_paths.h"

#include "sim/articulation/settings.h"
#include "sim/ccd/time_of_impact.h"

#include <algorithm>

namespace tumble {
namespace {

// The path of a part that begins `since` seconds after the body's present state, in straight motion.
Trajectory straight(const Body& body, double since) {
    Body there = body;
    there.position += since * body.velocity;
    const Trajectory turning = Trajectory::uniform(body, body.velocity, body.angular_velocity);
    there.orientation = turning.orientation(since);
    return Trajectory::uniform(there, body.velocity, body.angular_velocity);
}

}  // namespace

void FlightPaths::start(const std::vector<Body>& all, std::span<const std::uint32_t> bodies, int parts, double h) {
    bodies_ = bodies;
    parts_ = parts;
    span_ = h / parts;
    paths_.clear();
    for (const std::uint32_t i : bodies)
        for (int part = 0; part < parts; ++part) paths_.push_back(straight(all[i], part * span_));
}

void FlightPaths::add(std::size_t body, int part, const Body& before, const Body& after) {
    const Motion end{after.position, after.velocity, after.orientation, after.rotation, after.angular_velocity};
    paths_[body * std::size_t(parts_) + std::size_t(part)] = Trajectory::between(before, end, span_);
}

bool FlightPaths::meet(const Body& a, const Trajectory& path_a, const Body& b, const Trajectory& path_b) const {
    ImpactSearch search;  // fresh: its memory of axes would make the result depend on other pairs
    double since = 0.0;
    for (int trial = 0; trial < tuning::flight_searches; ++trial) {
        const TimeOfImpact found = search.find({&a, &path_a, since}, {&b, &path_b, since}, span_ - since);
        if (found.kind == TimeOfImpact::Kind::none) return false;
        if (found.kind == TimeOfImpact::Kind::impact) return true;
        since += found.time;
    }
    return true;
}

bool FlightPaths::any_meet(const std::vector<Body>& all, const std::vector<Manifold>& manifolds,
                           std::span<const std::uint32_t> of_island) const {
    std::uint32_t last_a = UINT32_MAX, last_b = UINT32_MAX;
    for (const std::uint32_t k : of_island) {
        const Manifold& m = manifolds[k];
        if (m.a == last_a && m.b == last_b) continue;  // the search finds all manifolds of a pair
        last_a = m.a;
        last_b = m.b;
        for (int part = 0; part < parts_; ++part) {
            Trajectory outside[2];
            const Trajectory* path[2];
            const std::uint32_t pair[2] = {m.a, m.b};
            for (int side = 0; side < 2; ++side) {
                const auto found = std::lower_bound(bodies_.begin(), bodies_.end(), pair[side]);
                const bool inside = found != bodies_.end() && *found == pair[side];
                if (!inside) outside[side] = straight(all[pair[side]], part * span_);
                const std::size_t place = std::size_t(found - bodies_.begin());
                path[side] = inside ? &paths_[place * std::size_t(parts_) + std::size_t(part)] : &outside[side];
            }
            if (meet(all[m.a], *path[0], all[m.b], *path[1])) return true;
        }
    }
    return false;
}

}  // namespace tumble
