// Poses in, finished frames out in order: all that the pipeline knows of drawing. How many processes or threads draw,
// and where OpenGL lives, is the drawer's own affair.
#pragma once

#include "app/bounded_queue.h"
#include "app/image_pool.h"
#include "app/stage_time.h"
#include "core/image.h"
#include "render/renderer.h"
#include "scene/description.h"
#include "sim/snapshot.h"

#include <cstdint>
#include <functional>
#include <memory>

namespace tumble {

/// One finished picture of the clip, shared by all outputs that read it.
struct Frame {
    std::int64_t number = 0;
    std::shared_ptr<const Image> image;
};

class Drawer {
public:
    virtual ~Drawer() = default;

    /// Takes poses until their queue ends, and hands each finished frame on, in the order of the poses. Stops early
    /// when `hand_on` says false. Throws RunError where drawing fails. Counts its work in `time`.
    virtual void run(BoundedQueue<Snapshot>& poses, const std::function<bool(Frame)>& hand_on, StageTime& time) = 0;
};

/// Draws in the thread that calls run(), which makes and owns the OpenGL context. The scene must outlive it.
class InProcessDrawer : public Drawer {
public:
    InProcessDrawer(const SceneDescription& scene, const RenderOptions& options);
    void run(BoundedQueue<Snapshot>& poses, const std::function<bool(Frame)>& hand_on, StageTime& time) override;

private:
    const SceneDescription& scene_;
    RenderOptions options_;
    ImagePool images_;
};

}  // namespace tumble
