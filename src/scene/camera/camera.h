// [camera], [cameras.NAME], [[shot]] and [[inset]]: poses and motions of cameras, and when each is used.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

#include <optional>
#include <string>

namespace tumble {

/// The camera of the file. Missing keys get values with which the bodies are in view. Precondition: `scene` has its
/// bodies and its output size.
/// With `[[shot]]` and `[[inset]]`, other cameras are its shots and insets. `named`: one of [cameras] for the whole
/// clip instead (--camera).
CameraDescription read_camera(const TomlTable& root, const SceneDescription& scene,
                              const std::optional<std::string>& named);

}  // namespace tumble
