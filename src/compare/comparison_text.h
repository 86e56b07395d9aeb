// Results of a comparison for other programs: JSON and JUnit XML (docs/reference/comparison.md).
#pragma once

#include "compare/comparison.h"

#include <string>

namespace tumble {

/// One object, with a line break at its end.
std::string to_json(const SetResult& result);

/// A <testsuite> with a <testcase> for each image: <failure> for different and added ones, <error> for missing and
/// broken ones.
std::string to_junit(const SetResult& result);

}  // namespace tumble
