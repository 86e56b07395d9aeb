// The result of a comparison of sets for people, on standard output.
#pragma once

#include "compare/comparison.h"

namespace tumble {

/// The pictures that are not alike, with reasons (of many, the first), and the number of each verdict; with `brief` the
/// pictures alone.
void print_summary(const SetResult& result, bool brief);

}  // namespace tumble
