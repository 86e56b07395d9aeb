// The inertia of a body, and the layers by which bodies choose what they collide with.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Reads `inertia`, `layers` and `collide_with`, and checks `center_of_mass`, of a body whose other fields are read.
void read_matter(const TomlTable& table, BodyDescription& body);

/// Fails where a body of the file collides with a layer of no body, or where the scene has too many layers.
void check_layers(const TomlTable& root, const SceneDescription& scene);

}  // namespace tumble
