// The command line of every program of the stability benchmark: runs its ways through the cases and writes rows of
// case,program,way,rate,parameter,value,limit,verdict to standard output.
#pragma once

#include "stability/stability_case.h"

namespace tumble::bench {

/// A way of a program to step, and the cases for which it makes a difference.
struct StabilityWay {
    std::string name;
    bool contacts = true;  // false: a way that differs from the program's first one in flight alone
    std::function<std::unique_ptr<Simulator>(const Scene&, double rate)> make;  // null: cannot represent the scene
    std::size_t most_bodies = 100000;
    bool water_and_breakage = false;  // true if it represents scenes with water and with bodies that break
};

/// Runs the cases and returns the exit code. Options: --case NAME and --way NAME (repeatable), --quick, --list,
/// --header.
int run_stability(int argc, char** argv, const std::string& program, const std::vector<StabilityWay>& ways);

}  // namespace tumble::bench
