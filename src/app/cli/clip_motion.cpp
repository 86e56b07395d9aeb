#include "app/cli/clip_motion.h"

#include "core/error.h"

namespace tumble {

void ClipMotion::open(const std::filesystem::path& folder, RenderScenes& scenes, std::int64_t first) {
    if (scenes.shows_damage())
        throw InputError(
            "--from-checkpoints: the overlay 'damage' shows changes since the frame before, which a part of a clip has "
            "not drawn; leave one of them out");
    checkpoints_.emplace(folder, TUMBLE_VERSION, scenes.identity());
    scenes.take_survey(checkpoints_->survey());
    state_ = checkpoints_->before(first);
}

void ClipMotion::make_panels(const RenderScenes& scenes, bool image, int threads) {
    const bool known = checkpoints_ && checkpoints_->has_motion();
    for (std::size_t i = 0; i < scenes.scenes.size(); ++i) {
        const std::int64_t end = scenes.ends[i], first = PanelRun::first_recorded(state_ ? state_->frame : 0, end);
        worlds_.push_back(known ? nullptr : std::make_unique<World>(scenes.world(i, threads)));
        recorded_.push_back(known ? std::make_unique<RecordedFrames>(*checkpoints_, i, first) : nullptr);
        overlays_.push_back(image ? scenes.overlay(i) : nullptr);
        panels_.push_back(
            {worlds_[i].get(), end, overlays_[i].get(), recorded_[i].get(), scenes.scenes[i].scene->bodies.size()});
    }
}

}  // namespace tumble
