// Frames, AOVs and clip of a sample, drawn in the calling thread: the same bytes as by `tumble render`.
#pragma once

#include "app/clip/render_scenes.h"
#include "app/sweep/sample_folder.h"
#include "app/sweep/sweep_plan.h"
#include "app/workers/shared_frames.h"
#include "render/render_switches.h"

#include <cstdint>

namespace tumble {

/// The outputs of a frame, with the marks of `tumble render`. Throws InputError where the clip's format cannot hold it.
FrameOutputs frame_outputs(const SweepPlan& plan, const RenderScenes& scenes);

RenderOptions render_options(const SampleDrawing& drawing);
Shutter shutter_of(const SampleDrawing& drawing);

/// Simulates and draws. `scenes` has been surveyed. Returns the number of frames that were drawn.
std::int64_t write_clip(const SweepPlan& plan, const RenderScenes& scenes, GlDevice* device, SampleFolder& folder);

}  // namespace tumble
