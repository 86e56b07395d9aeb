// The content of a Scene.
#pragma once

#include "scene/load.h"
#include "tumble/scene.h"

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

namespace tumble::v0 {

struct SceneData {
    std::shared_ptr<const SceneDescription> description;
    FileList files;  // that were read
    OutputSettings output;

    /// Bodies by name, made by the first call from any thread.
    const std::unordered_map<std::string_view, std::size_t>& names() const;
    /// The description with its camera by the motion, which the first call from any thread simulates.
    const SceneDescription& drawn() const;

private:
    mutable std::once_flag named_, framed_;
    mutable std::shared_ptr<const SceneDescription> drawn_;
    mutable std::unordered_map<std::string_view, std::size_t> names_;  // only looked up
};

/// The description as a Scene, which shares it.
Scene make_scene(std::shared_ptr<const SceneDescription> description, FileList files);

}  // namespace tumble::v0
