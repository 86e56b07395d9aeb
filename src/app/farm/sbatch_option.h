// An option that is passed on to sbatch, in a line of the scripts' settings.
#pragma once

#include <string>
#include <string_view>

namespace tumble {

/// Throws InputError for a text that is no single option, and for an option that the scripts set themselves, in any
/// spelling that sbatch reads: "-oX", "-QoX", "--out=X".
void check_sbatch_option(const std::string& option);

/// "--KEY=VALUE" or "-K VALUE" as sbatch reads it from a line of #SBATCH. Precondition: check_sbatch_option() has passed.
std::string sbatch_line(const std::string& option);

/// A value in such a line, which sbatch takes apart by its own rules: '#' begins a comment, quotes are removed.
std::string sbatch_value(std::string_view text);

}  // namespace tumble
