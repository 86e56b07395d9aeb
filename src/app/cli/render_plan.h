// The outputs of a render, and the frames that it draws for that: those of the command, less those that --resume
// keeps.
#pragma once

#include "app/cli/commands.h"
#include "app/clip/render_scenes.h"
#include "app/pipeline/pipeline.h"
#include "app/resume/frame_identity.h"
#include "app/resume/segmented_clip.h"
#include "output/video_format.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace tumble {

struct RenderPlan {
    std::optional<std::filesystem::path> clip, folder, aov_folder;
    std::optional<VideoFormat> format;  // of the clip
    ClipOptions clip_options;
    FrameIdentity pictures, aovs;
    PipelineFrames frames;
    std::unique_ptr<SegmentedClip> segments;  // with --resume and a clip

    /// Frames that an output needs, and those that are drawn: damage needs the frames before them too.
    std::int64_t needed() const { return frames.folder.united_with(frames.aovs).united_with(frames.video).count(); }
    std::int64_t to_draw() const { return frames.drawn.count(); }
    FrameOutputs outputs(const RenderCommand& command) const;
};

/// Looks at the outputs of earlier runs, and writes nothing. Throws InputError for outputs that do not fit together,
/// that would replace an input, or that belong to another clip; RunError if a clip is wanted and there is no ffmpeg.
RenderPlan plan_render(const RenderCommand& command, const RenderScenes& scenes);

}  // namespace tumble
