// The keys of a case: [[case]] and [defaults] of a golden.toml.
#pragma once

#include "app/golden/suite.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>
#include <optional>

namespace tumble {

/// Throws InputError at the first unknown key of [defaults].
void check_default_keys(const TomlTable& defaults);

/// A case of the table; keys that it has not come from `defaults`. Relative scenes are relative to `folder`.
GoldenCase read_case(const TomlTable& table, const std::optional<TomlTable>& defaults,
                     const std::filesystem::path& folder);

}  // namespace tumble
