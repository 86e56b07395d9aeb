// The motion of the panels of a clip: simulated or recorded, from the start of the clip or from a checkpoint.
#pragma once

#include "app/checkpoints/checkpoint_folder.h"
#include "app/checkpoints/recorded_frames.h"
#include "app/cli/render_scenes.h"
#include "app/pipeline/panel_run.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

class ClipMotion {
public:
    /// Goes on from the last checkpoint of a folder at or before a frame, and gives the scenes the survey in it. Without
    /// this the motion is simulated from the start. Throws InputError where the folder is not of this clip.
    void open(const std::filesystem::path& folder, RenderScenes& scenes, std::int64_t first);
    /// `image`: pictures are drawn, with overlays. The scenes must outlive the panels.
    void make_panels(const RenderScenes& scenes, bool image, int threads);

    std::span<const PanelSource> panels() const { return panels_; }
    /// To go on from; none: the start of the clip.
    const std::optional<ClipState>& state() const { return state_; }

private:
    std::optional<CheckpointReading> checkpoints_;
    std::optional<ClipState> state_;
    // By panel; no world where the motion is recorded.
    std::vector<std::unique_ptr<World>> worlds_;
    std::vector<std::unique_ptr<RecordedFrames>> recorded_;
    std::vector<std::unique_ptr<OverlayBuilder>> overlays_;
    std::vector<PanelSource> panels_;
};

}  // namespace tumble
