// TOML values as JSON, in the order of the file.
#pragma once

#include "scene/toml/toml_reader.h"

#include <nlohmann/json.hpp>

namespace tumble {

/// Infinities and NaN, which JSON lacks, become strings: "inf", "nan".
nlohmann::ordered_json json_of(const toml::node& value);
/// The same for the text of a value.
nlohmann::ordered_json json_of(const std::string& toml);

}  // namespace tumble
