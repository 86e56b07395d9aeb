// Rotations given by directions.
#pragma once

#include "core/vector.h"

namespace tumble {

/// The smallest rotation from the direction `from` to the direction `to` (of nonzero vectors). For opposite ones: half
/// a turn about a perpendicular axis. In its own unit, because Eigen's function compiles a singular value
/// decomposition.
Quat rotation_between(const Vec3& from, const Vec3& to);

}  // namespace tumble
