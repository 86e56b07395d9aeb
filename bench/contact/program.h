// The command line of every program of the contact benchmark: runs its ways through the cases and writes rows of
// case,program,way,quantity,value,unit to standard output.
#pragma once

#include "contact/contact_case.h"

namespace tumble::bench {

/// A way of a program to step: settings, threads, sleep.
struct Way {
    std::string name;
    std::vector<Task> tasks;
    std::function<std::unique_ptr<Simulator>(const Scene&, double rate)> make;  // null: cannot represent the scene
    std::size_t most_bodies = 100000;
};

/// Runs the cases once and returns the exit code. Options: --case NAME and --way NAME (repeatable), --patience S (CPU
/// seconds after which a case is cut short), --quick, --list, --header.
int run_contact(int argc, char** argv, const std::string& program, const std::vector<Way>& ways);

}  // namespace tumble::bench
