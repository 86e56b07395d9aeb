// With exact impacts, the frame and the order that the bodies are computed in: those of the scene itself, not of its file. A scene
// far from the world's origin keeps the digits of one at it, and the list of its bodies decides nothing.
#pragma once

#include "scene/description.h"
#include "sim/body.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// The middle (m, world) of the dynamic bodies' places; the world's origin where there are none.
Vec3 local_origin(const SceneDescription& scene);

/// The scene with `origin` for its origin: its bodies and keyframes. What is only drawn stays in the world's frame.
SceneDescription seen_from(const SceneDescription& scene, const Vec3& origin);

/// Moves the bodies into an order that follows from where and what they are, and tells which of them (by its place before) is where.
std::vector<std::uint32_t> put_in_order_of_place(std::vector<Body>& bodies);

}  // namespace tumble
