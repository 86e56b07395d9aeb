// [light] and [wind]: the surroundings of the bodies.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

LightDescription read_light(const TomlTable& root);
std::optional<WindDescription> read_wind(const TomlTable& root);

}  // namespace tumble
