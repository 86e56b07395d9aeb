// The tables of a plan that describe values: [[axis]], and `b` of [pair].
#pragma once

#include "app/sweep/sweep_axis.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// Throws InputError.
SweepAxis read_axis(const TomlTable& table);

/// `values`, `range` or `distribution` with its keys; other keys must have been checked.
AxisSource read_source(const TomlTable& table);

/// Checks the path of a key, "body.crate.mass", without the scene.
std::string read_path(const TomlValue& value);

}  // namespace tumble
