// Meshes for every scene: unit box, unit balls of several levels of detail, unit cylinder.
#pragma once

#include "scene/description/description.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Triangles for drawing, counter-clockwise seen from outside.
struct DrawMesh {
    std::vector<MeshAsset::Vertex> vertices;
    std::vector<std::uint32_t> indices;
};

/// The three faces on the high sides of the cube [-1, 1]^3, with seven corners, for depth-only passes. Its normals are
/// those of a ball.
DrawMesh make_half_box();

/// The square [-1, 1]^2 x 0, which the shader maps to one face of the cube.
DrawMesh make_face();

/// A ball of radius 1: an icosahedron whose faces are split into four `level` times (Fuller's geodesic sphere).
DrawMesh make_ball(int level);

/// The cylinder of radius 1 about the y axis from -1 to 1.
DrawMesh make_cylinder(int sides);

}  // namespace tumble
