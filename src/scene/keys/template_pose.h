// Another pose of a template: coordinates of its joints, by forward kinematics.
#pragma once

#include "scene/keys/templates.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Moves the bodies so that hinges and sliders have the given coordinates (`pose = { NAME = degrees or m }`). Fixed and
/// kinematic bodies and the world stay; without them, the first body of each group of joined bodies.
void apply_pose(const TomlValue& pose, SceneTemplate& content);

}  // namespace tumble
