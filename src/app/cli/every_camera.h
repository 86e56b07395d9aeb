// --camera all: a render for each camera of a scene.
#pragma once

#include "app/cli/render_command.h"

#include <vector>

namespace tumble {

/// The command, or with --camera all one for [camera] and one for each of [cameras], in the order of their names. Each
/// writes into a folder of its camera's name inside the folders of the command. Throws InputError for outputs that can
/// hold one camera only.
std::vector<RenderCommand> of_each_camera(const RenderCommand& command);

}  // namespace tumble
