// `tumble compare` of folders, clips and scenes: many pairs of pictures, with tolerances by file and results as files.
#pragma once

#include "app/cli/commands.h"

namespace tumble {

/// True if the command is more than the comparison of two pictures by the options of the command line.
bool compares_sets(const CompareCommand& command);

/// Returns the exit code of the result (compare/comparison.h). Throws InputError before anything is compared if the
/// operands or the tolerances are wrong.
int compare_sets(const CompareCommand& command);

}  // namespace tumble
