// A closed mesh approximated by a few boxes inside it, as occluders: a ring must not occlude a body in its hole.
#pragma once

#include "core/triangle_mesh.h"
#include "render/scene/render_scene.h"

namespace tumble {

/// At most 16 disjoint boxes inside the mesh, the largest first; none for an open mesh, which has no inside. The mesh's
/// bounds are divided into a grid of about 12 cells along the longest edge. A cell is inside if its center is; the
/// cells inside are joined greedily into boxes.
std::vector<OccluderBox> make_mesh_occluders(const TriangleMesh& mesh);

}  // namespace tumble
