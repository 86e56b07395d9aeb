// The content of a Scene.
#pragma once

#include "scene/load.h"
#include "tumble/scene.h"

#include <string>
#include <unordered_map>

namespace tumble::v0 {

struct SceneData {
    SceneDescription description;
    FileList files;  // that were read
    OutputSettings output;
    std::unordered_map<std::string, std::size_t> names;  // of bodies; only looked up
};

/// The description as a Scene.
Scene make_scene(SceneDescription description, FileList files);

}  // namespace tumble::v0
