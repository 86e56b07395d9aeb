// From the file of a plan to its values (docs/reference/sweep-plan.md).
#pragma once

#include "app/sweep/sweep_plan.h"

#include <filesystem>

namespace tumble {

/// Throws InputError with file, line and column for any violation of the format.
SweepPlan read_plan(const std::filesystem::path& file);

}  // namespace tumble
