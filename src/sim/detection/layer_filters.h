// The layers of the bodies of a scene, for pairs that never collide. Empty where all bodies collide with all.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/body_pair.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tumble {

class LayerFilters {
public:
    LayerFilters() = default;
    explicit LayerFilters(const std::vector<Body>& bodies) {
        const auto meets_all = [&](const Body& body) {
            return (body.collides_with & bodies[0].layers) != 0 && body.collides_with == bodies[0].collides_with &&
                   body.layers == bodies[0].layers;
        };
        if (std::all_of(bodies.begin(), bodies.end(), meets_all)) return;
        filters_.reserve(bodies.size());
        for (const Body& body : bodies) filters_.push_back({body.layers, body.collides_with});
    }

    bool empty() const { return filters_.empty(); }
    /// True if one of the two collides with no layer of the other.
    bool keep_apart(const BodyPair& pair) const {
        if (empty()) return false;
        const Filter &a = filters_[pair.a], &b = filters_[pair.b];
        return (a.collides_with & b.layers) == 0 || (b.collides_with & a.layers) == 0;
    }

private:
    struct Filter {
        std::uint64_t layers, collides_with;
    };
    std::vector<Filter> filters_;  // by body
};

}  // namespace tumble
