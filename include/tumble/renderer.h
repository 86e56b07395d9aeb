// Drawing without a display.
#pragma once

#include "image.h"
#include "scene.h"
#include "snapshot.h"

#include <memory>
#include <string>
#include <vector>

TUMBLE_BEGIN

enum class Backend {
    osmesa,
    egl,       // on a graphics card if there is one
    software,  // OSMesa where it is installed, otherwise EGL's software device: the same pixels
};

struct RenderOptions {
    Backend backend = Backend::software;
    std::string shader_folder;  // empty: $TUMBLE_SHADERS, otherwise the installed one
    bool transparent = false;   // bodies alone, on a transparent background: straight alpha
};

/// One OpenGL context and one image. Draws in the calling process; used from the thread that made it. Several renderers
/// may take turns in one thread. Each call leaves its own OpenGL context current.
class Renderer {
public:
    /// Opens the driver and compiles the shaders. Keeps the data of the scene alive. Where the motion decides the
    /// camera (Camera::fit), simulates the scene once, for all renderers of it. Throws Error (run) where one of both
    /// fails.
    explicit Renderer(const Scene& scene, const RenderOptions& options = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Draws the poses at the scene's output size, from where the camera is at their time. The image belongs to the
    /// renderer and is valid until the next call: copy it to keep it. Only changes since the last call are drawn.
    /// Throws Error (input) where the snapshot does not hold each body of the scene, Error (run) where the driver
    /// fails.
    const Image& render(const Snapshot& snapshot);

    /// The mean, in linear light, of the images at these moments: motion blur (see FrameSequence). At least one, of
    /// transparent images at most 256; each counts as rendered. The image belongs to the renderer and is valid until
    /// the next call. Throws like render().
    const Image& render_blurred(const std::vector<Snapshot>& moments);

    /// Takes note of a frame that is not drawn. A body that moves by less than 0.02 pixels is drawn where it was, so
    /// frame n has the bytes of `tumble render` when each frame before it was rendered or skipped, in order. Throws
    /// like render().
    void skip(const Snapshot& snapshot);

    /// The name and the version of the OpenGL driver.
    std::string driver() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

TUMBLE_END
