// [[speed]]: slow motion and stops of a clip.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Refers to bodies by name. Precondition: `scene` has its bodies.
void read_speed(const TomlTable& root, SceneDescription& scene);

}  // namespace tumble
