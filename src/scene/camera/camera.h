// [camera]: the camera's pose and motion.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// The camera of the file. Missing keys get values with which the bodies are in view. Precondition: `scene` has its
/// bodies and its output size.
CameraDescription read_camera(const TomlTable& root, const SceneDescription& scene);

}  // namespace tumble
