// The command line: the commands and their options. The only place with their names and help texts.
#pragma once

namespace tumble {

/// Reads the arguments and runs the command. Returns the exit code: 0 done, 1 failed or different, 2 wrong usage.
/// Errors of the command itself leave it as InputError or RunError.
int run_command_line(int argc, char** argv);

}  // namespace tumble
