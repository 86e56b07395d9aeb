// The definitions of the command line as plain data.
#pragma once

#include "app/manual/command_text.h"

#include <CLI/CLI.hpp>

namespace tumble {

/// The command with its options and commands, without those of group "", which the help does not show either.
manual::CommandText read_command(CLI::App& command);

}  // namespace tumble
