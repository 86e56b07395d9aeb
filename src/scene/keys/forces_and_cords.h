// [[force]] and [[cord]]: forces at points of bodies, and drawn cords.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Both refer to bodies by name. Precondition: `scene` has its bodies.
void read_forces(const TomlTable& root, SceneDescription& scene);
void read_cords(const TomlTable& root, SceneDescription& scene);

}  // namespace tumble
