// A template in another size.
#pragma once

#include "scene/keys/templates.h"
#include "scene/mesh/mesh_loader.h"

namespace tumble {

/// Enlarges all lengths by `scale` and all masses by `mass_factor`. Motion under gravity stays similar: forces grow as
/// masses, times as the root of lengths. Speeds and times that are given do not change.
void enlarge(SceneTemplate& content, double scale, double mass_factor, MeshCache& meshes);

}  // namespace tumble
