// The text of a joint of a SceneSpec.
#pragma once

#include "api/spec_lines.h"

#include <cstddef>
#include <string>

namespace tumble::v0 {

void write_joint(const Joint& joint, std::size_t index, SpecLines& lines);

}  // namespace tumble::v0
