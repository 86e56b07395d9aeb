#include "core/vector.h"

namespace tumble {

Quat rotation_between(const Vec3& from, const Vec3& to) { return Quat::FromTwoVectors(from, to); }

}  // namespace tumble
