// Which surface a pixel shows, written into its alpha while the picture is drawn: smooth edges need to know. Eight bits
// are few, so surfaces share numbers, but hardly neighbours; where two do, an edge between them stays as it is drawn.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble {

/// Of a drawn body's face (0 for what has only one surface): 1 .. 253. The sky has 255.
inline std::uint8_t surface_id(std::size_t body, std::size_t face) { return std::uint8_t(1 + (6 * body + face) % 253); }

/// The same as the shaders write it.
inline float surface_alpha(std::size_t body, std::size_t face) { return float(surface_id(body, face)) / 255.0f; }

}  // namespace tumble
