// Conversion from double-precision vectors of the simulation to float vectors of OpenGL.
#pragma once

#include "core/vector.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace tumble {

inline glm::vec3 to_glm(const Vec3& v) { return {float(v.x()), float(v.y()), float(v.z())}; }
inline glm::vec4 to_glm(const Vec3& v, double w) { return {to_glm(v), float(w)}; }
/// A quaternion as the shaders read it: x, y, z, w.
inline glm::vec4 to_glm(const Quat& q) { return {float(q.x()), float(q.y()), float(q.z()), float(q.w())}; }

}  // namespace tumble
