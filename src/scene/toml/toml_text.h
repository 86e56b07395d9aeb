// A parsed TOML document as text again: the same values to the bit, in the order of the file, without its comments.
#pragma once

#include "scene/toml/toml_reader.h"

#include <string>

namespace tumble {

/// A number as TOML, with all digits that distinguish it: 0.1, 5.0, 1e+20, inf.
std::string toml_number(double value);
/// A string in quotes.
std::string toml_string(std::string_view text);
/// A value on one line: arrays and tables inline.
std::string toml_value_text(const toml::node& value);
/// The whole document. Keys that were set (set_values.h) follow those of the file.
std::string toml_document_text(const toml::table& document);

/// The entries in that order.
std::vector<std::pair<const toml::key*, const toml::node*>> entries_in_order(const toml::table& table);

}  // namespace tumble
