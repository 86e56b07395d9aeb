// poses = "FILE.csv": many bodies from one table, a row of the file for each.
#pragma once

#include "scene/description/description.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class BodyNames;

struct PosedBodies {
    std::vector<BodyDescription> bodies;
    std::vector<std::string_view> columns;  // fields of PoseRow that the file has, such as "x,y,z"

    bool has(std::string_view field) const { return std::ranges::find(columns, field) != columns.end(); }
};

/// The bodies of a CSV text: the model with the values of a row. The first row names the columns, in any order: x,y,z
/// (required) and the others of PoseRow (scene/fields/many_bodies_fields.h).
/// - `file`: for errors, InputError at file, line and column.
/// - `names`: gets the names of the bodies.
/// - `before`: number of bodies of the scene before these.
PosedBodies read_posed_bodies(std::string_view text, const std::string& file, const BodyDescription& model,
                              BodyNames& names, std::int64_t before);

}  // namespace tumble
