// A render from the command to its files, without messages but for the progress.
#pragma once

#include "app/cli/render_command.h"
#include "app/clip/render_scenes.h"
#include "app/files/frame_set.h"
#include "app/pipeline/pipeline.h"
#include "app/resume/frame_identity.h"
#include "app/resume/segmented_clip.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace tumble {

/// The outputs of a render, and the frames that it draws for that: frames of the command, less frames that --resume
/// keeps.
struct RenderPlan {
    std::optional<std::filesystem::path> clip, folder, aov_folder;
    std::optional<VideoFormat> format;  // of the clip
    ClipOptions clip_options;
    FrameIdentity pictures, aovs;
    PipelineFrames frames;
    std::unique_ptr<SegmentedClip> segments;  // with --resume and a clip

    /// Frames that an output needs, and frames that are drawn: damage needs the frames before them too.
    std::int64_t needed() const { return frames.folder.united_with(frames.aovs).united_with(frames.video).count(); }
    std::int64_t to_draw() const { return frames.drawn.count(); }
    FrameOutputs outputs(const RenderCommand& command) const;
    /// The WAV file that goes into the clip.
    void set_sound(const std::filesystem::path& file);
};

/// Looks at the outputs of earlier runs, and writes nothing. Throws InputError for outputs that do not fit together,
/// that would replace an input, or that belong to another clip; RunError if a clip is wanted and there is no ffmpeg.
RenderPlan plan_render(const RenderCommand& command, const RenderScenes& scenes);

/// CPU time of the stages, s, over all threads and processes.
struct StageSeconds {
    double simulation = 0.0, drawing = 0.0, png = 0.0, aovs = 0.0, conversion = 0.0, video = 0.0;
};

/// Figures of a finished render.
struct RenderFigures {
    int width = 0, height = 0;                          // of the frames, pixels
    double fps = 0.0;                                   // of the clip
    std::int64_t clip_frames = 0;                       // of the whole clip
    FrameSet frames;                                    // that were asked for,
    std::int64_t rendered = 0;                          // and those among them that were not kept from an earlier run
    std::int64_t drawn = 0;                             // frames that differ from the one before
    std::optional<std::filesystem::path> clip, folder;  // written; of the frames
    std::optional<std::filesystem::path> aov_folder;
    std::int64_t frames_in_clip = 0, frames_stored = 0;
    VideoKind kind = VideoKind::h264;  // of the clip
    int frame_step = 1;                // of the clip's format
    int workers = 1, threads = 1;
    StageSeconds cpu;
    double seconds = 0.0;          // wall clock
    std::int64_t peak_memory = 0;  // MiB, over all processes
};

/// Throws InputError before anything is simulated or written, RunError afterwards.
RenderFigures render_to_files(const RenderCommand& command);

}  // namespace tumble
