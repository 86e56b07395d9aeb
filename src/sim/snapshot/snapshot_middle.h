// A state between two that follow each other.
#pragma once

#include "sim/snapshot/snapshot.h"

namespace tumble {

/// The middle of a step, with the constant velocities that lead from one state to the next.
Snapshot middle_of(const Snapshot& a, const Snapshot& b);

}  // namespace tumble
