// [camera], [light] and [wind]: what surrounds the bodies.
#pragma once

#include "scene/description.h"
#include "scene/toml_reader.h"

namespace tumble {

LightDescription read_light(const TomlTable& root);
std::optional<WindDescription> read_wind(const TomlTable& root);

/// The camera of the file. What it leaves out is chosen so that the bodies are in view;
/// call it when `scene` has its bodies and its output size.
CameraDescription read_camera(const TomlTable& root, const SceneDescription& scene);

}  // namespace tumble
