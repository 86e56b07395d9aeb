// A gear: the coordinates of two hinges or sliders in a fixed relation, theta_1 + ratio theta_2 = constant. It has no
// frames of its own; its force acts along the coordinates of its two joints, which touch up to four bodies.
#pragma once

#include "sim/joints/joint.h"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// The free coordinate of a hinge or a slider.
std::size_t geared_coordinate(const Joint& joint);

/// The coordinates of both joints of a gear at one pose.
struct GearGeometry {
    std::array<JointGeometry, 2> joints;
    std::array<double, 2> value{};  // rad or m
    double error = 0.0;             // of the first coordinate: value[0] + ratio value[1] less the constant

    JointCoordinate coordinate(const Joint& joint, std::size_t which) const {
        return joints[which].coordinates[geared_coordinate(joint)];
    }
};

/// `side`: the pose of a side by body, or Joint::world.
template <class Side>
GearGeometry measure_gear(const Joint& gear, std::span<const Joint> joints, const Side& side) {
    GearGeometry g;
    for (std::size_t s = 0; s < 2; ++s) {
        const Joint& joint = joints[gear.description.geared[s]];
        g.joints[s] = measure(joint, side(joint.a), side(joint.b));
        g.value[s] = g.coordinate(joint, s).value;
    }
    g.error = g.value[0] + gear.description.ratio * g.value[1] - gear.value[Joint::gear_constant];
    return g;
}

/// True if both joints of a gear hold.
bool gear_holds(const Joint& gear, std::span<const Joint> joints);

/// Sets the bodies and the size of a gear between joints that are built.
void build_gear(Joint& gear, std::span<const Joint> joints, const std::vector<Body>& bodies);

/// The gear's relation starts at the present coordinates: where the gear begins to hold.
void engage_gear(Joint& gear, std::span<const Joint> joints, const std::vector<Body>& bodies);

/// Error of a gear's relation at the present poses, m: angles times the size of the first joint.
double gear_gap(const Joint& gear, std::span<const Joint> joints, const std::vector<Body>& bodies);

}  // namespace tumble
