// [camera]: where it stands, and how it moves.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// The camera of the file. What it leaves out is chosen so that the bodies are in view;
/// call it when `scene` has its bodies and its output size.
CameraDescription read_camera(const TomlTable& root, const SceneDescription& scene);

}  // namespace tumble
