// Builds the render scene: the bodies, and the data that ambient occlusion keeps of them.
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

RenderScene make_render_scene(const SceneDescription& description);

}  // namespace tumble
