// Preprocessor definitions of all shaders of a scene.
#pragma once

#include "render/scene/render_scene.h"

#include <string>
#include <vector>

namespace tumble {

/// Without an environment, lights, exposure and tone of its own, a scene has none.
std::vector<std::string> scene_defines(const RenderScene& scene);

}  // namespace tumble
