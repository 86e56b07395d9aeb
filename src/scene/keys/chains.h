// [[chain]]: a row of equal bodies, each joined to the next.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/bodies.h"
#include "scene/toml/toml_reader.h"

#include <vector>

namespace tumble {

/// Appends the links NAME.0, NAME.1, ... of all chains, and their joints: NAME.i is at the start of link i.
void read_chains(const TomlTable& root, const BodySources& sources, std::vector<BodyDescription>& bodies,
                 std::vector<JointDescription>& joints);

}  // namespace tumble
