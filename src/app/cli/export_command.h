// A scene and its motion as a glTF file in memory: for `tumble export`, and for the download of a page.
#pragma once

#include "app/threads/interrupt.h"
#include "gltf/key_track.h"
#include "scene/description/description.h"

#include <cstddef>
#include <vector>

namespace tumble {

struct ExportedScene {
    std::vector<std::byte> bytes;
    double position_error = 0.0, rotation_error = 0.0;  // largest, m and rad
};

/// Simulates the scene. Throws RunError after an interrupt.
ExportedScene export_scene(const SceneDescription& scene, KeyKind keys, int threads, bool quiet, Interrupt& interrupt);

}  // namespace tumble
