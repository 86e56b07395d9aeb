// Sample points of the sky visibility of a mesh: its vertices, or one vertex for many of a finely tessellated mesh.
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

/// Fills in the samples of mesh.asset and the sample of each vertex. At most about 2000 samples: vertices in one grid
/// cell with normals in one octant share one.
void set_vertex_samples(RenderMesh& mesh);

}  // namespace tumble
