// Draws a frame from a snapshot. The renderer has the render scene, camera, light and poses, but no simulation.
#pragma once

#include "core/image.h"
#include "render/camera/camera.h"
#include "render/camera/lens.h"
#include "render/gl/gl_context.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tumble {

struct RenderSwitches;

struct RenderOptions {
    GlBackend backend = GlBackend::software;
    std::filesystem::path shader_folder;  // empty: found beside the program, installed, or in the source tree
    bool transparent = false;  // straight alpha instead of the sky and the planes, which light bodies all the same
};

/// One OpenGL context and its resources. Use it in the thread that made it.
class Renderer {
public:
    /// Throws RunError if no context can be made or a shader is missing or broken (with the compiler's log).
    explicit Renderer(const SceneDescription& scene, const RenderOptions& options = {});
    /// With the switches of render_switches.h.
    Renderer(const SceneDescription& scene, const RenderSwitches& switches);
    ~Renderer();

    /// Draws the snapshot at the scene's output size, with the camera at the snapshot's time. The image is valid until
    /// the next call. Only regions that changed since the previous call are drawn. Resting bodies are cheap only if
    /// their poses are the same to the bit, which PoseFilter provides. A camera movement redraws everything. Through a
    /// lens, the image is the mean of those through its points; of these, a moment of a frame has its share.
    const Image& render(const Snapshot& snapshot, const FrameMoment& moment = {});

    /// Regions in which the current image may differ from the previous one: rectangles that do not overlap. The whole
    /// image after the first render() and with full_redraw; empty if nothing moved.
    const std::vector<Rectangle>& changed() const;

    /// Depths of the current image, and its camera; with a lens, as seen from its middle. Precondition of depths(): the
    /// switch keep_depths.
    const DepthImage& depths() const;
    const Camera& camera() const;

    /// The OpenGL renderer and version, as the driver names itself.
    std::string driver() const;

private:
    const Image& draw(const Snapshot& snapshot, const Eigen::Vector2d& lens_point);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tumble
