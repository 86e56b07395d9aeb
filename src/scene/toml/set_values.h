// Values of the command line (--set PATH=VALUE) in a parsed scene: any key of the scene by its path.
#pragma once

#include "scene/toml/error_text.h"
#include "scene/toml/toml_reader.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// Sets each "PATH=VALUE" in the document, in order.
/// - PATH: keys joined by '.', as in "simulation.integrator", "body.crate.position" or "camera.keyframes.0.time". An
///   element of an array of tables is named by its "name" or by its number from 0. A key with a '.' stands in quotes.
/// - VALUE: a TOML value; text that is none is a string.
/// Throws InputError for a path without '=', and for an element that does not exist. Keys are checked where the
/// document is read: errors about these values name the option.
void set_values(toml::table& document, std::span<const std::string> assignments);

/// A value as set_values() takes it.
struct SetValue {
    std::optional<double> number;  // otherwise text
    std::string text;
};

/// The value of that path; none where the document does not give it, or gives a list or a table. Throws InputError for
/// an element of an array that does not exist.
std::optional<SetValue> value_of_path(toml::table& document, std::string_view path);

/// "--set PATH" if the node or key comes from such an assignment.
std::optional<std::string> set_option(const toml::source_region& source);

}  // namespace tumble
