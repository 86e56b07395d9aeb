// Reads the output of the lessons' compiler.
#pragma once

#include "app/lesson/course.h"

#include <string_view>

namespace tumble {

/// Throws RunError if the text is not what the compiler writes.
Course read_course(std::string_view json);

}  // namespace tumble
