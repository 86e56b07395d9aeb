// Types of joints and the keys of each.
#pragma once

#include "scene/fields/choices.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// The type of a joint's table. Fails at an unknown key, and at a key of another type.
JointType read_joint_type(const TomlTable& table);

}  // namespace tumble
