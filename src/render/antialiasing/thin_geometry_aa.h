// Boxes thinner than a pixel. Pixels' middles miss them here and hit them there: drawn as they are they were dashes that flicker.
// They are drawn about a pixel wide (body.vert), so that their color is known all along, and then each pixel gets the
// share of it that they truly cover, and the rest from beside them.
#pragma once

#include "core/image.h"
#include "render/damage/dirty_tiles.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Boxes are rods where two of their sides are less than twice the first and the third more than twice the last: specks stand
/// in crowds, where nothing is to be seen beside them. Rods are drawn no thinner than twice the second.
inline constexpr double widest_rod_pixels = 0.6, thinnest_rod_pixels = 0.53, shortest_rod_pixels = 5.0 * widest_rod_pixels;

/// Is it a box of such size whose half edges are these, in pixels?
bool is_rod(const Vec3& half_pixels);

struct ScreenRod {
    double x0, y0, x1, y1;       // the ends of its middle line, pixels from the top left corner
    double half0, half1;         // how far it reaches to both sides of that at the ends, pixels
    std::uint8_t first_face;     // the number of its face 0 (surface_ids.h)
};

/// Gives the pixels of the marked tiles their shares of the rods. After blend_analytic_edges().
void blend_rods(const Image& drawn, const std::vector<ScreenRod>& rods, const DirtyTiles& marks, Image& frame);

}  // namespace tumble
