// The meshes that every scene can need: unit box, unit balls of several finenesses, unit cylinder.
#pragma once

#include "scene/description/description.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Triangles for drawing, counter-clockwise from outside.
struct DrawMesh {
    std::vector<MeshAsset::Vertex> vertices;
    std::vector<std::uint32_t> indices;
};

/// The three faces on the high sides of the cube [-1, 1]^3, with seven corners: where only depth is wanted. Their normals
/// are those of a ball.
DrawMesh make_half_box();

/// The square [-1, 1]^2 x 0, which the shader puts on one face of the cube.
DrawMesh make_face();

/// A ball of radius 1: an icosahedron whose faces are split into four `level` times (Fuller's geodesic sphere).
DrawMesh make_ball(int level);

/// The cylinder of radius 1 about the y axis from -1 to 1, without caps (a cord's ends are hidden).
DrawMesh make_cylinder(int sides);

}  // namespace tumble
