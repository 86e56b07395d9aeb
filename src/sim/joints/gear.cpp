#include "sim/joints/gear.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

JointSide place_of_side(const std::vector<Body>& bodies, std::uint32_t body) {
    if (body == Joint::world) return {};
    return {bodies[body].position, bodies[body].orientation};
}

}  // namespace

std::size_t geared_coordinate(const Joint& joint) { return joint.description.type == JointType::slider ? 0 : 3; }

bool gear_holds(const Joint& gear, std::span<const Joint> joints) {
    return std::all_of(gear.description.geared.begin(), gear.description.geared.end(),
                       [&](std::size_t k) { return joints[k].active && !joints[k].broken; });
}

// The bodies of the gear stand for the bodies of its joints: dynamic ones, two different ones where there are such, and
// rather the second ones of the joints.
void build_gear(Joint& gear, std::span<const Joint> joints, const std::vector<Body>& bodies) {
    const Joint &first = joints[gear.description.geared[0]], &second = joints[gear.description.geared[1]];
    const auto moves = [&](std::uint32_t i) { return i != Joint::world && bodies[i].dynamic(); };
    for (const bool different : {false, true})
        for (const std::uint32_t a : {first.a, first.b})
            for (const std::uint32_t b : {second.a, second.b}) {
                if (!moves(a) || !moves(b) || (a != b) != different) continue;
                gear.a = a;
                gear.b = b;
            }
    gear.size = std::min(first.size, second.size);
    engage_gear(gear, joints, bodies);
}

void engage_gear(Joint& gear, std::span<const Joint> joints, const std::vector<Body>& bodies) {
    const GearGeometry g = measure_gear(gear, joints, [&](std::uint32_t body) { return place_of_side(bodies, body); });
    gear.value[Joint::gear_constant] = g.value[0] + gear.description.ratio * g.value[1];
}

double gear_gap(const Joint& gear, std::span<const Joint> joints, const std::vector<Body>& bodies) {
    const GearGeometry g = measure_gear(gear, joints, [&](std::uint32_t body) { return place_of_side(bodies, body); });
    const Joint& first = joints[gear.description.geared[0]];
    return std::abs(g.error) * (geared_coordinate(first) < 3 ? 1.0 : first.size);
}

}  // namespace tumble
