// Draws a frame from a snapshot. The renderer has the render scene, camera, light and poses, but no simulation.
#pragma once

#include "core/image.h"
#include "core/rectangle.h"
#include "render/gl/gl_backend.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tumble {

class ShaderCompileSchedule;
struct PassTimes;

struct RenderOptions {
    GlBackend backend = GlBackend::osmesa;
    std::filesystem::path shader_folder;  // empty: found beside the program, installed, or in the source tree
    bool full_redraw = false;  // redraw every frame completely, with the same bytes: for tests and comparisons
    bool draw_hidden = false;  // draw bodies behind boxes as well: for tests and comparisons
    bool multisample = false;  // several samples per pixel, as in scenes with cords: for comparisons
    double shift_x = 0.0, shift_y = 0.0;  // displacement of the frame, below 1 pixel: for averages of many frames
    PassTimes* times = nullptr;           // sums of the costs of passes; must outlive the renderer
    ShaderCompileSchedule* compile_schedule = nullptr;  // shared with the other processes that draw this scene, or null
};

/// One OpenGL context and its resources. Use it in the thread that made it.
class Renderer {
public:
    /// Throws RunError if no context can be made or a shader is missing or broken (with the compiler's log).
    Renderer(const SceneDescription& scene, const RenderOptions& options);
    ~Renderer();

    /// Draws the snapshot at the scene's output size, with the camera at the snapshot's time. The image is valid until
    /// the next call. Only regions that changed since the previous call are drawn. Resting bodies are cheap only if
    /// their poses are the same to the bit, which PoseFilter provides. A camera movement redraws everything.
    const Image& render(const Snapshot& snapshot);

    /// Regions in which the current image may differ from the previous one: rectangles that do not overlap. The whole
    /// image after the first render() and with full_redraw; empty if nothing moved.
    const std::vector<Rectangle>& changed() const;

    /// The OpenGL renderer and version, as the driver names itself.
    std::string driver() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tumble
