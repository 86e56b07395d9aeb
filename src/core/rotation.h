// Rotations that are built from directions.
#pragma once

#include "core/vector.h"

namespace tumble {

/// The least turn that takes the direction `from` to that of `to` (lengths above zero). For opposite ones: half a turn about an
/// axis across them. In a unit of its own, for Eigen's function brings a singular value decomposition to compile.
Quat turn_between(const Vec3& from, const Vec3& to);

}  // namespace tumble
