// The command line: the table of commands, and the call of one.
#pragma once

namespace tumble {

/// Reads the arguments and runs the command. Returns the exit code: 0 done, 1 failed or different, 2 wrong usage.
/// Errors of the command itself leave it as InputError or RunError.
int run_command_line(int argc, char** argv);

}  // namespace tumble
