// Faces of a file that are wound one way here and the other way there.
#pragma once

#include "core/triangle_mesh.h"

#include <vector>

namespace tumble {

/// Which triangles to turn so that those that share an edge agree: of a closed piece, to face outward; of an open one as most of
/// its area does. A piece that agrees already stays as it is (a hollow's inner side faces inward), and so does one that
/// cannot agree, as a Moebius strip.
std::vector<char> triangles_to_turn(const TriangleMesh& mesh);

}  // namespace tumble
