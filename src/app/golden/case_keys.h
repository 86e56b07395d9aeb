// The keys of a case: [[case]] and [defaults] of a golden.toml.
#pragma once

#include "app/golden/suite.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>
#include <optional>

namespace tumble {

/// Throws InputError at the first unknown key of [defaults].
void check_default_keys(const TomlTable& defaults);

/// A case of the table; keys that it does not have come from `defaults`. Relative scenes are relative to the folder of
/// the suite's file; its tolerances are the base of the case's.
GoldenCase read_case(const TomlTable& table, const std::optional<TomlTable>& defaults, const GoldenSuite& suite);

/// A table with the keys of tolerances.toml, or the name of such a file.
Tolerances read_tolerances(const TomlValue& value, const std::filesystem::path& folder,
                           const PairTolerances& base = {});

}  // namespace tumble
