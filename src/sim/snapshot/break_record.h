// One bond that failed, as plain values: a row of the table --breaks.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble {

struct BreakRecord {
    double time = 0.0;       // s
    std::size_t body = 0;    // index of the whole body in the scene
    std::size_t bond = 0;    // index in FractureDescription::bonds
    double area = 0.0;       // m^2
    double tension = 0.0;    // N along the normal; negative: compression
    double bending = 0.0;    // N m, across the normal
    double shear = 0.0;      // N, across the normal
    double torsion = 0.0;    // N m about the normal
    double energy = 0.0;     // J, that the new surface took from the motion
    std::size_t pieces = 0;  // of the body, after the blow or the load
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [time, body, bond, area, tension, bending, shear, torsion, energy, pieces] = self;
        archive.body(body);
        archive.any(bond, pieces);
        archive.keep(time, area, tension, bending, shear, torsion, energy);
    }
};

}  // namespace tumble
