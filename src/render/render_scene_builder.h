// The whole render scene of a scene: its bodies, and the data that ambient occlusion keeps of them.
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

RenderScene make_render_scene(const SceneDescription& scene);

}  // namespace tumble
