// poses = "FILE.csv": many bodies from one table, a row of the file for each.
#pragma once

#include "scene/description/description.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class BodyNames;

struct PosedBodies {
    std::vector<BodyDescription> bodies;
    // Columns of the file; the bodies have other values from the model.
    bool names = false, rotations = false, velocities = false, angular_velocities = false;
};

/// The bodies of a CSV text: the model with the values of a row. The first row names the columns, in any order: x,y,z
/// (m, required), body (the name), qw,qx,qy,qz, vx,vy,vz (m/s) and wx,wy,wz (rad/s).
/// - `file`: for errors, InputError at file, line and column.
/// - `names`: gets the names of the bodies.
/// - `before`: number of bodies of the scene before these.
PosedBodies read_posed_bodies(std::string_view text, const std::string& file, const BodyDescription& model,
                              BodyNames& names, std::int64_t before);

}  // namespace tumble
