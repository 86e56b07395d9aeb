#include "app/drawer.h"

#include <optional>
#include <utility>

namespace tumble {

InProcessDrawer::InProcessDrawer(const SceneDescription& scene, const RenderOptions& options)
    : scene_(scene), options_(options) {}

void InProcessDrawer::run(BoundedQueue<Snapshot>& poses, const std::function<bool(Frame)>& hand_on, StageTime& time) {
    std::optional<Renderer> renderer;
    Image picture;
    {
        const StageTimer timer(time);
        renderer.emplace(scene_, options_);
    }
    while (const std::optional<Snapshot> pose = poses.pop()) {
        std::shared_ptr<Image> image = images_.take();
        {
            const StageTimer timer(time);
            renderer->render(*pose, picture);   // writes what changed only
            *image = picture;
        }
        if (!hand_on({pose->frame, std::move(image)})) return;
    }
}

}  // namespace tumble
