// From a snapshot to a picture. The renderer knows the scene's looks, camera and light, and poses; not how bodies move.
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
    bool full_redraw = false;             // every frame anew, to the same bytes: for tests and comparisons
    bool draw_hidden = false;             // what lies behind boxes as well: for tests and comparisons
    bool multisample = false;             // edges by several samples a pixel, as where cords are drawn: for comparisons
    double shift_x = 0.0, shift_y = 0.0;  // pixels that the picture is moved by, under one: for averages of many
    PassTimes* times = nullptr;         // where to sum up what the stages cost; must outlive the renderer
    ShaderCompileSchedule* turns = nullptr;    // shared with the other processes that draw this scene, if there are any
};

/// One OpenGL context and what is uploaded to it. Use it from the thread that made it.
class Renderer {
public:
    /// Throws RunError when no context can be made or a shader is missing or broken (with the compiler's words).
    Renderer(const SceneDescription& scene, const RenderOptions& options);
    ~Renderer();

    /// Draws the snapshot at the scene's output size, from where the camera is at its time. Only what changed since the
    /// last render() is drawn and written: a `frame` of the right size must hold the picture that render() made before
    /// (any copy of it will do); another size, an empty image for one, is replaced by the whole picture. Bodies that do
    /// not move cost little only when their poses are the same to the bit: PoseFilter sees to that. A camera that has
    /// moved has everything drawn.
    void render(const Snapshot& snapshot, Image& frame);

    /// Where the last picture may differ from the one this renderer drew before it: rectangles that do not overlap. The
    /// whole picture after the first render() and with full_redraw; none when nothing drawn has moved.
    const std::vector<Rectangle>& changed() const;

    /// The OpenGL renderer and version, as the driver names itself.
    std::string driver() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tumble
