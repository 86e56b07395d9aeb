// Analytic antialiasing with one sample per pixel. The edges are known (screen_edges.h), and so is the share of each
// pixel beyond an edge; that share of the color is taken from the neighbor across the edge. After Persson 2011,
// Geometric Post-process Anti-Aliasing, with exact areas, and with surface ids in alpha that tell which edges are
// visible. It costs a hundredth of four samples per pixel, and straight edges have all shades instead of five.
#pragma once

#include "core/image.h"
#include "render/antialiasing/screen_edges.h"
#include "render/damage/dirty_tiles.h"

#include <vector>

namespace tumble {

/// Copies the rectangles of the drawn image to the frame, with alpha 255.
void copy_opaque(const Image& drawn, const std::vector<Rectangle>& rectangles, Image& frame);

/// Blends the edges in the dirty tiles of the frame, which must hold the drawn image there. `with_coverage`: the
/// frame's alpha is coverage (antialiasing.h) and is blended too.
void blend_analytic_edges(const Image& drawn, const std::vector<ScreenEdge>& edges, const DirtyTiles& dirty,
                          Image& frame, bool with_coverage = false);

/// The mean over x in [-half, half] of clamp(t - x, 0, 1): the share of a strip, one pixel high and 2 half of the slope
/// wide, before a line.
double share_before(double t, double half);

}  // namespace tumble
