// [simulation], [output], [light] and [wind]. For the first two, the file and the command line are merged first, each
// value with its source, and checked together after that: a step that fits the file's fps may not fit that of --fps.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/overrides.h"
#include "scene/toml/toml_reader.h"

#include <optional>

namespace tumble {

/// Reads both tables (either may be missing) with the overrides.
void read_run_settings(const TomlTable& root, const SceneOverrides& overrides, SimulationSettings& simulation,
                       OutputSettings& output);

/// [light], or all of [[light]] with the one that has shadows as the light.
void read_lights(const TomlTable& root, SceneDescription& scene);
std::optional<WindDescription> read_wind(const TomlTable& root);
PairRules read_contact(const TomlTable& root);

}  // namespace tumble
