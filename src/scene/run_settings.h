// [simulation] and [output]: how long, how fine, how it is computed, and the frames that come out.
// The file and the command line are merged first, each value with its origin, and checked together afterwards:
// a step that fits the file's fps may not fit the one of --fps.
#pragma once

#include "scene/load.h"
#include "scene/toml_reader.h"

namespace tumble {

/// Reads both tables (either may be missing) under the overrides.
void read_run_settings(const TomlTable& root, const SceneOverrides& overrides, SimulationSettings& simulation,
                       OutputSettings& output);

}  // namespace tumble
