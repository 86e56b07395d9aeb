#include "app/workers/frame_filter.h"

#include "core/check.h"
#include "sim/checkpoint/archive.h"

#include <utility>

namespace tumble {

FrameFilter::FrameFilter(const Composition& composition, const FrameOutputs& outputs)
    : composition_(composition), outputs_(outputs), aov_changes_(*composition.aov_scene) {
    for (const ClipPanel& panel : composition.panels) panels_.emplace_back(*panel.scene);
}

bool FrameFilter::follow(MotionBlurFrame& frame_poses, bool anew) {
    if (!outputs_.image() || (!follow_image(frame_poses) && !anew)) frame_poses.panels.clear();
    if (frame_poses.aovs && !aov_changes_.follow(*frame_poses.aovs) && !anew) frame_poses.aovs.reset();
    return !frame_poses.panels.empty() || frame_poses.aovs;
}

void FrameFilter::restore(std::size_t panel, std::span<const std::byte> poses) {
    CheckpointReader reader(poses);
    reader.keep(panels_.at(panel).poses);
}

/// Selects the poses to draw of all panels; false: the image equals that of the previous frame.
bool FrameFilter::follow_image(MotionBlurFrame& frame_poses) {
    TUMBLE_CHECK_EQ(frame_poses.panels.size(), panels_.size());
    bool changed = composition_.changes(last_time_, frame_poses.time);
    last_time_ = frame_poses.time;
    for (std::size_t i = 0; i < panels_.size(); ++i)
        if (panels_[i].follow(frame_poses.panels[i])) changed = true;
    for (std::size_t i = 0; i < frame_poses.overlays.size(); ++i)
        if (panels_[i].overlay != frame_poses.overlays[i]) {
            panels_[i].overlay = frame_poses.overlays[i];
            changed = true;
        }
    return changed;
}

/// Replaces the samples by those to draw; false: the image of the panel equals that of the previous frame. If nothing
/// moves while the shutter is open, one moment is left.
bool FrameFilter::PanelFilter::follow(PanelPoses& moments) {
    bool first = false, later = false;
    const std::span<Snapshot> samples = drawn_moments(moments);
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (poses.follow(samples[i])) (i == 0 ? first : later) = true;
    if (!later) {
        if (moments.size() > 1) moments.front() = std::move(samples.front());
        moments.resize(1);
    }
    const bool moved_before = std::exchange(moves, later);
    return first || later || moved_before;
}

}  // namespace tumble
