// From a snapshot to a picture. The renderer knows the scene's looks, camera and light, and poses; not how bodies move.
#pragma once

#include "core/image.h"
#include "scene/description.h"
#include "sim/snapshot.h"

#include <filesystem>
#include <memory>
#include <string>

namespace tumble {

enum class GlBackend { osmesa, egl };

struct RenderOptions {
    GlBackend backend = GlBackend::osmesa;
    std::filesystem::path shader_folder;  // empty: found beside the program, installed, or in the source tree
};

/// One OpenGL context and what is uploaded to it. Use it from the thread that made it.
class Renderer {
public:
    /// Throws RunError when no context can be made or a shader is missing or broken (with the compiler's words).
    Renderer(const SceneDescription& scene, const RenderOptions& options);
    ~Renderer();

    /// Draws the snapshot at the scene's output size into `frame` (resized as needed).
    void render(const Snapshot& snapshot, Image& frame);

    /// The OpenGL renderer and version, as the driver names itself.
    std::string driver() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Where the shaders are: $TUMBLE_SHADERS, else beside the installed program, else the source tree it was built from.
/// Throws RunError naming the places looked at.
std::filesystem::path find_shader_folder();

}  // namespace tumble
