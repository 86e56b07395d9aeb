// Surface ids, written into alpha during drawing for analytic antialiasing. Eight bits are few: surfaces share ids, but
// seldom neighboring ones; an edge between two of the same id is not smoothed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble {

/// Ids from 1 on.
inline constexpr int surface_id_count = 253;
/// Id of the sky.
inline constexpr std::uint8_t sky_id = 255;

/// A pixel as drawn where only bodies and shadows on the ground are: red, green and blue times the coverage, which is
/// all for a surface. Beside surfaces the color is the darkness of a shadow.
inline std::array<std::uint8_t, 4> covered_color(const std::uint8_t* pixel) {
    if (pixel[3] == sky_id) return {0, 0, 0, pixel[0]};
    return {pixel[0], pixel[1], pixel[2], 255};
}

/// Id of a face of a drawn body (face 0 for shapes with one surface).
inline std::uint8_t surface_id(std::size_t body, std::size_t face) {
    return std::uint8_t(1 + (6 * body + face) % std::size_t(surface_id_count));
}

/// True if an id belongs to the same box as the id of one of its faces.
inline bool of_same_box(std::uint8_t id, std::uint8_t of_face, std::uint8_t face) {
    int from_first = id - of_face + face;  // if the id counter wrapped between both, this is off by the number of ids
    from_first += from_first < 0 ? surface_id_count : from_first >= surface_id_count ? -surface_id_count : 0;
    return from_first < 6 && id <= surface_id_count;
}

/// The same value as the shaders write it.
inline float surface_alpha(std::size_t body, std::size_t face) { return float(surface_id(body, face)) / 255.0f; }

}  // namespace tumble
