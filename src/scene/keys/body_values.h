// Values of a body whose keys depend on each other: its motion, its inertia, and its collision layers.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Reads `inertia`, `layers` and `collide_with`, and checks `center_of_mass`, of a body whose other fields are read.
void read_matter(const TomlTable& table, BodyDescription& body);

/// Fails where a body of the file collides with a layer of no body, or where the scene has too many layers.
void check_layers(const TomlTable& root, const SceneDescription& scene);

/// Checks the motion of a body whose fields are read, and reads its keyframes. With keyframes, its pose is that of the
/// first one.
void check_motion(const TomlTable& table, BodyDescription& body);

/// `[w, x, y, z]`, of unit length (a norm within 1e-3 of 1 is normalized), or `{ axis = [...], angle = degrees }`.
Quat read_rotation(const TomlValue& value);

}  // namespace tumble
