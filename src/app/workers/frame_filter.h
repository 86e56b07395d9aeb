// The poses that a frame needs to be made from: of resting bodies always the same ones, and none where the frame equals
// the one before. It runs on the frames in order, before they are handed to render processes.
#pragma once

#include "app/composition/composition.h"
#include "app/workers/motion_blur_frame.h"
#include "app/workers/shared_frames.h"
#include "render/aov/aov_renderer.h"
#include "render/scene/pose_filter.h"

#include <cstddef>
#include <span>
#include <vector>

namespace tumble {

class FrameFilter {
public:
    FrameFilter(const Composition& composition, const FrameOutputs& outputs);

    /// Removes the poses of outputs that equal those of the previous frame. False: the whole frame equals it, which is
    /// not allowed where that was not drawn (`anew`).
    bool follow(MotionBlurFrame& frame_poses, bool anew);

    /// The state of a panel's pose filter from a checkpoint. Throws InputError.
    void restore(std::size_t panel, std::span<const std::byte> poses);

private:
    /// The filtered poses of one panel.
    struct PanelFilter {
        explicit PanelFilter(const SceneDescription& scene) : poses(scene) {}
        bool follow(PanelPoses& moments);
        PoseFilter poses;
        std::vector<std::byte> overlay;  // of the previous frame
        bool moves = false;              // true if bodies moved while the shutter was open for the previous frame
    };
    bool follow_image(MotionBlurFrame& frame_poses);

    Composition composition_;
    FrameOutputs outputs_;
    std::vector<PanelFilter> panels_;
    AovChanges aov_changes_;
    double last_time_ = 0.0;  // s, of the last frame
};

}  // namespace tumble
