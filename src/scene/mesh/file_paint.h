// The looks of a loaded mesh from the materials and colors of its file.
#pragma once

#include "core/triangle_mesh.h"
#include "scene/description/mesh_paint.h"
#include "scene/mesh/mesh_file.h"

#include <array>
#include <memory>
#include <vector>

namespace tumble {

/// `corners`: of the triangles of `mesh`, in their order. Null if none of them has a material and no vertex a color.
std::shared_ptr<const MeshPaint> make_paint(const MeshFile& file, const TriangleMesh& mesh,
                                            const std::vector<std::array<MeshFile::Corner, 3>>& corners);

}  // namespace tumble
