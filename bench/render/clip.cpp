#include "render/clip.h"

#include "render/scene/pose_filter.h"
#include "sim/world.h"

namespace tumble::bench {

std::vector<Snapshot> drawn_clip(const SceneDescription& scene, int first, int end) {
    World world(scene);
    PoseFilter drawn(scene);
    std::vector<Snapshot> clip;
    for (int frame = 0; frame < end; ++frame) {
        if (frame > 0) world.advance_frame();
        Snapshot snapshot = world.snapshot();
        drawn.follow(snapshot);
        if (frame >= first) clip.push_back(std::move(snapshot));
    }
    return clip;
}

}  // namespace tumble::bench
