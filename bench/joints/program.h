// The command line of every program of the joints benchmark: runs its ways through the cases and writes rows of
// case,program,way,step,quantity,value,unit to standard output.
#pragma once

#include "joints/joint_case.h"

namespace tumble::bench {

/// A way of a program to step: integrator, solver, threads.
struct JointWay {
    std::string name;
    std::vector<JointTask> tasks;
    std::function<std::unique_ptr<Simulator>(const Scene&, double rate)> make;  // null: cannot represent the scene
    std::size_t most_bodies = 100000;
};

/// Runs the cases once and returns the exit code. Options: --case NAME and --way NAME (repeatable), --patience S (CPU
/// seconds after which a step is cut short and finer ones are left out), --quick, --list, --header.
int run_joints(int argc, char** argv, const std::string& program, const std::vector<JointWay>& ways);

}  // namespace tumble::bench
