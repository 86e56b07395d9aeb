// The scenes of `tumble render`, their place in the frame, and the frames of the clip.
#pragma once

#include "app/cli/commands.h"
#include "app/composition/make_composition.h"
#include "app/files/frame_set.h"
#include "app/plots/plotted_run.h"
#include "app/threads/interrupt.h"
#include "overlay/overlay_builder.h"
#include "sim/frames/clip_timing.h"
#include "sim/world.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tumble {

class RenderScenes {
public:
    /// Loads and checks the scenes. Throws InputError if they do not fit together.
    RenderScenes(const RenderCommand& command, const Shutter& shutter);

    /// Simulates all scenes once, if a plot or the scale of arrows needs it, and fills them in. Leaves no thread behind.
    void survey_clip(int threads, Interrupt& interrupt);

    const SceneDescription& first() const { return *scenes.front().scene; }
    std::size_t bodies() const;
    World world(std::size_t index, int threads) const;
    /// True if a panel shows dirty regions, which are those of a single render process.
    bool shows_damage() const;
    /// The maker of a panel's overlay; null without one. Valid after survey_clip().
    std::unique_ptr<OverlayBuilder> overlay(std::size_t index) const;

    std::vector<ClipScene> scenes;   // the timing is that of the simulation, with the intervals of the shutter
    std::vector<std::int64_t> ends;  // one after the last frame of each scene
    FileList inputs;
    FrameSet frames;               // that the command asks for
    std::int64_t clip_frames = 0;  // of the longest scene
    Composition composition;

private:
    void load(const RenderCommand& command);
    void fill_plots();
    void add_overlays();
    void read_plot(const RenderCommand& command, CompositionOptions& options);

    Shutter shutter_;
    std::vector<PlottedRun> runs_;  // one for each scene if there is a plot
};

}  // namespace tumble
