// A folder of pictures as an input.
#pragma once

#include "app/files/output_plan.h"

#include <filesystem>

namespace tumble {

/// Its pictures and motion records, and all names that would be such files. Throws InputError if it cannot be read.
void add_compared_folder(const std::filesystem::path& folder, OutputPlan& plan);

}  // namespace tumble
