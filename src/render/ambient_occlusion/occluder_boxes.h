// A closed mesh as a few boxes inside it, for ambient occlusion: a ring must not darken what lies in its hole.
#pragma once

#include "core/triangle_mesh.h"
#include "render/scene/render_scene.h"

namespace tumble {

/// At most 16 disjoint boxes inside the mesh, the largest first; none for an open mesh, which has no inside.
/// The mesh's bounds are cut into a lattice of about 12 cells along the longest edge; a cell counts as inside when its
/// center is, and full cells are joined greedily into boxes.
std::vector<OccluderBox> make_mesh_occluders(const TriangleMesh& mesh);

}  // namespace tumble
