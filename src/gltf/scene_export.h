// A scene and its recorded motion as a glTF 2.0 file: meshes, materials, camera, light and animation. Infinite planes
// become finite squares; patterns of two colors become their mean, and cords are left out.
#pragma once

#include "gltf/motion_recorder.h"
#include "scene/description/description.h"

#include <cstddef>
#include <string>
#include <vector>

namespace tumble {

struct GltfExport {
    const SceneDescription& scene;
    const MotionRecorder& motion;     // finished
    CameraDescription camera;         // at the start
    double moments_per_second = 0.0;  // of the recorded motion
    std::string generator;            // name and version of the program
};

/// The bytes of the file. Throws RunError if they exceed the limits of the format.
std::vector<std::byte> make_glb(const GltfExport& source);

}  // namespace tumble
