// [[force]] and [[cord]]: forces at points of bodies, and drawn cords.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Both refer to bodies and joints by name. Precondition: `scene` has its bodies and joints.
void read_forces(const TomlTable& root, SceneDescription& scene);
void read_cords(const TomlTable& root, SceneDescription& scene);

/// Appends a cord for each joint that is visible.
void add_cords_of_joints(SceneDescription& scene);

}  // namespace tumble
