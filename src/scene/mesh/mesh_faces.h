// Faces of a loaded mesh: one winding, and normals for drawing if the file has none (smooth across gentle edges, hard
// across sharp ones).
#pragma once

#include "core/triangle_mesh.h"

#include <array>
#include <vector>

namespace tumble {

/// The triangles to turn so that those that share an edge are consistent: a closed component is oriented outward, an
/// open one like most of its area. A consistent component is unchanged (the inner surface of a hollow faces inward),
/// and so is one that cannot be consistent, such as a Moebius strip.
std::vector<char> triangles_to_flip(const TriangleMesh& mesh);

/// A unit normal for every corner of every triangle: the mean of the normals of the faces at its vertex, weighted by
/// their angles there (Thuermer and Wuethrich 1998), over those that differ from the corner's own face by less than the
/// crease angle. Precondition: the mesh is welded and its triangles have area.
std::vector<std::array<Vec3, 3>> crease_normals(const TriangleMesh& mesh);

/// The unit normal of a triangle; zero if it has no area.
Vec3 face_normal(const TriangleMesh& mesh, std::size_t triangle);

}  // namespace tumble
