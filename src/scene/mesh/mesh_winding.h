// Repairs inconsistent winding of faces.
#pragma once

#include "core/triangle_mesh.h"

#include <vector>

namespace tumble {

/// The triangles to turn so that those that share an edge are consistent: a closed component is oriented outward, an
/// open one like most of its area. A consistent component is unchanged (the inner surface of a hollow faces inward),
/// and so is one that cannot be consistent, such as a Moebius strip.
std::vector<char> triangles_to_flip(const TriangleMesh& mesh);

}  // namespace tumble
