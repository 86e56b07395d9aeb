// With exact impacts, the frame and the order of the bodies are those of the scene itself, not of its file. A scene far
// from the world's origin keeps the digits of one at the origin, and the order of the file does not affect results.
#pragma once

#include "scene/description/description.h"
#include "sim/dynamics/body.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// The middle (m, world) of the dynamic bodies' positions; the world's origin without dynamic bodies.
Vec3 local_origin(const SceneDescription& scene);

/// The scene with its bodies and keyframes relative to `origin`. Objects that are only drawn stay in the world's frame.
SceneDescription seen_from(const SceneDescription& scene, const Vec3& origin);

/// Moves the bodies into the order of spatial_sort.h, starting from one that follows from the bodies' positions and
/// properties alone. Returns for each index the body's index in the scene. `gravity`: m/s^2.
std::vector<std::uint32_t> put_in_exact_order(std::vector<Body>& bodies, const Vec3& gravity);

}  // namespace tumble
