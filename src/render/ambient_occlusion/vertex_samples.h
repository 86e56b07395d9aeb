// Where a mesh's sky light is worked out: at its vertices, or, for a fine mesh, at one vertex for many.
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

/// Fills in the probes of look.asset and each vertex's. At most about 2000 probes: vertices in one cell of a lattice
/// whose normals lie in one octant share one.
void set_mesh_probes(RenderMesh& look);

}  // namespace tumble
