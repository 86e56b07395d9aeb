// The command line of every program of the benchmark: runs its variants through the cases and writes rows of
// case,program,variant,step,error,unit,cpu_seconds_per_simulated_second to standard output.
#pragma once

#include "accuracy/simulator.h"

namespace tumble::bench {

/// Runs the cases and returns the exit code. Options: --case NAME and --variant NAME (repeatable), --quick, --list,
/// --header.
int run_accuracy(int argc, char** argv, const std::string& program, const std::vector<Variant>& variants);

}  // namespace tumble::bench
