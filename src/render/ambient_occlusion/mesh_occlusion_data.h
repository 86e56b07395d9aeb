// The data that ambient occlusion keeps of a mesh: boxes that stand for it as an occluder, and the points at which its
// sky visibility is computed.
#pragma once

#include "core/triangle_mesh.h"
#include "render/scene/render_scene.h"

namespace tumble {

/// A closed mesh approximated by a few boxes inside it: a ring must not occlude a body in its hole.
/// At most 16 disjoint boxes inside the mesh, the largest first; none for an open mesh, which has no inside. The mesh's
/// bounds are divided into a grid of about 12 cells along the longest edge. A cell is inside if its center is; the
/// cells inside are joined greedily into boxes.
std::vector<OccluderBox> make_mesh_occluders(const TriangleMesh& mesh);

/// Sample points of the sky visibility: the vertices, or one vertex for many of a finely tessellated mesh.
/// Fills in the samples of mesh.asset and the sample of each vertex. At most about 2000 samples: vertices in one grid
/// cell with normals in one octant share one.
void set_vertex_samples(RenderMesh& mesh);

}  // namespace tumble
