// Initial pose and velocity of a body; the keyframes of a kinematic one.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Checks the motion of a body whose fields are read, and reads its keyframes. With keyframes, its pose is that of the
/// first one.
void check_motion(const TomlTable& table, BodyDescription& body);

/// `[w, x, y, z]`, of unit length (a norm within 1e-3 of 1 is normalized), or `{ axis = [...], angle = degrees }`.
Quat read_rotation(const TomlValue& value);

}  // namespace tumble
