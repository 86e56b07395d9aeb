// The scripts and the job template of src/app/farm/templates, which are compiled in.
#pragma once

#include <string_view>

namespace tumble {

/// The text of a file in that folder. Marks such as @SETTINGS@ stand for values of the job.
std::string_view farm_template(std::string_view name);

}  // namespace tumble
