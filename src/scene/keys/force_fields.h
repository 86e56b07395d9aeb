// [[field]] and [[pair_force]].
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Reads both, after the bodies.
void read_force_fields(const TomlTable& root, SceneDescription& scene);

}  // namespace tumble
