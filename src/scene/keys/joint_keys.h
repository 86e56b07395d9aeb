// Types of joints and the keys of each.
#pragma once

#include "scene/fields/choices.h"
#include "scene/toml/toml_reader.h"

#include <string_view>

namespace tumble {

inline std::string_view type_name(JointType type) { return name_of(type); }

/// The type of a joint's table. Fails at an unknown key, and at a key of another type.
JointType read_joint_type(const TomlTable& table);

}  // namespace tumble
