// Antialiasing of boxes thinner than a pixel ("rods"). Pixel centers hit them irregularly, so without treatment they
// would be flickering dashes. They are drawn about a pixel wide (body.vert), so that their color is known everywhere;
// then each pixel gets its true coverage of it, and the rest from beside the rod.
#pragma once

#include "core/image.h"
#include "render/damage/dirty_tiles.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Half extents on the screen, pixels. A box is a rod if its median one is below the first value and its longest above
/// the last: specks come in crowds, without a visible background beside them. Rods are drawn with at least the second
/// value.
inline constexpr double widest_rod_pixels = 0.6, thinnest_rod_pixels = 0.53,
                        shortest_rod_pixels = 5.0 * widest_rod_pixels;

/// True if a box with these half edges, in pixels, is a rod.
bool is_rod(const Vec3& half_pixels);

struct ScreenRod {
    double x0, y0, x1, y1;    // ends of its center line, pixels from the top left corner
    double half0, half1;      // half widths at the ends, pixels
    std::uint8_t first_face;  // surface id of its face 0 (surface_ids.h)
};

/// Blends the rods into the pixels of the dirty tiles by coverage. Call it after blend_analytic_edges(),
/// with the same `with_coverage`.
void blend_rods(const Image& drawn, const std::vector<ScreenRod>& rods, const DirtyTiles& dirty, Image& frame,
                bool with_coverage = false);

}  // namespace tumble
