// Initial pose and velocity of a body; the keyframes of a kinematic one.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Reads position, rotation, velocity, angular_velocity, keyframes and interpolation into a body whose type is known.
/// With keyframes, its pose is that of the first one.
void read_motion(const TomlTable& table, BodyDescription& body);

/// `[w, x, y, z]`, of unit length (a norm within 1e-3 of 1 is normalized), or `{ axis = [...], angle = degrees }`.
Quat read_rotation(const TomlValue& value);

}  // namespace tumble
