// The joints of a scene at the start, for `tumble info`. A group is a set of dynamic bodies connected by joints; the
// world, fixed and kinematic bodies connect none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace tumble {

/// The way in which an island of joined bodies moves in a step: see sim/joints/joint_way.h.
enum class JointWay : std::uint8_t { free, direct, sweeps };

struct JointReport {
    std::size_t bodies = 0;              // dynamic ones with joints
    std::size_t degrees_of_freedom = 0;  // of these: 6 a body minus the rank of the joints' rows
    std::size_t groups = 0, trees = 0;   // trees: groups without loops
    std::size_t loops = 0;               // joints beyond a tree from the world
    std::size_t rows = 0;                // locked coordinates
    std::size_t redundant = 0;           // rows that follow from others
    // Groups by JointWay, where they touch nothing, and where they touch something.
    std::array<std::size_t, 3> in_flight{}, in_contact{};
    std::size_t swept() const { return in_contact[std::size_t(JointWay::sweeps)]; }
    // Bodies of figures. Beside contacts they are solved in sweeps while `crowd` of them touch something; 0: never.
    std::size_t figures = 0, crowd = 0;
    bool counted = true;      // false: a group is so large that all of its rows count as independent
    double mass_ratio = 1.0;  // largest of two dynamic bodies of a joint
    double gap = 0.0;         // m, largest
    std::optional<std::size_t> heaviest, widest;  // joints with these; in the order of the scene
};

}  // namespace tumble
