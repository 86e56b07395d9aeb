#include "app/cli/render_plan.h"

#include "app/checkpoints/checkpoint_folder.h"
#include "app/clip/drawing_settings.h"
#include "app/files/aov_folder.h"
#include "app/files/frame_folder.h"
#include "app/files/output_plan.h"
#include "app/resume/kept_frames.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/encoder_report.h"

#include <fmt/format.h>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The folder of the AOVs, if any are requested.
std::optional<fs::path> folder_of_aovs(const RenderCommand& command) {
    if (command.aovs.empty() && command.aov_folder)
        throw InputError("--aov-folder: needs --aov with the AOVs to write, as in --aov depth,normal");
    if (command.aovs.empty()) return std::nullopt;
    if (!command.aov_folder && !command.frames)
        throw InputError("--aov: needs --frames or --aov-folder for the folder to write to");
    return command.aov_folder ? command.aov_folder : command.frames;
}

/// Throws InputError if an output would replace another one or an input.
void check_outputs(const RenderCommand& command, const RenderPlan& plan, const RenderScenes& scenes) {
    OutputPlan files;
    files.add_inputs(scenes.inputs);
    if (command.from_checkpoints) {
        files.add_inputs(checkpoint_files_in(*command.from_checkpoints));
        files.add_input_folder(*command.from_checkpoints, is_checkpoint_name);
    }
    if (command.motion_record && (command.resume || command.from_checkpoints))
        throw InputError("--motion-record: is of a whole run, without --resume and --from-checkpoints");
    if (command.motion_record) files.add("--motion-record", *command.motion_record);
    if (plan.clip) files.add("--output", *plan.clip);
    if (plan.aov_folder && command.aovs.has(Aov::segmentation))
        files.add("--aov", segmentation_table_path(*plan.aov_folder));
    if (command.report) files.add("--report", *command.report);
    if (command.profile) files.add("--profile", *command.profile);
    const auto add_series = [&](const char* option, const fs::path& folder, FrameFiles kind) {
        const bool pictures = kind == FrameFiles::pictures;
        files.add(option, manifest_path(folder, kind));
        files.add({option, folder, pictures ? "frame_" : "aov_", pictures ? ".png" : ".npz",
                   pictures ? frame_path : aov_path, scenes.frames.first(), scenes.frames.end()});
    };
    if (plan.folder) add_series("--frames", *plan.folder, FrameFiles::pictures);
    if (plan.aov_folder) add_series("--aov", *plan.aov_folder, FrameFiles::aovs);
}

DrawingChoices choices_of(const RenderCommand& command) {
    return {command.shutter, command.blur_samples, command.drawing.transparent, command.drawing.backend};
}

/// The frames of a folder that are to be drawn.
FrameSet missing_in(const RenderCommand& command, const fs::path& folder, FrameFiles kind,
                    const FrameIdentity& identity, const FrameSet& wanted) {
    if (command.resume || command.frames_range) require_same_clip(folder, kind, identity);
    if (!command.resume) return wanted;
    const FrameSet kept = kept_frames(folder, kind, identity, wanted);
    return wanted.where([&](std::int64_t n) { return !kept.contains(n); });
}

}  // namespace

FrameOutputs RenderPlan::outputs(const RenderCommand& command) const {
    FrameOutputs outputs{std::nullopt,    folder.has_value(), command.aovs, command.drawing.transparent,
                         pictures.mark(), aovs.mark()};
    if (format) outputs.video = format->pixels;
    return outputs;
}

RenderPlan plan_render(const RenderCommand& command, const RenderScenes& scenes) {
    const double fps = scenes.first().output.fps;
    RenderPlan plan;
    plan.folder = command.frames;
    plan.aov_folder = folder_of_aovs(command);
    plan.clip = command.clip;
    plan.clip_options = command.clip_options;
    plan.clip_options.transparent = command.drawing.transparent;
    if (!plan.clip && !plan.folder && !plan.aov_folder)
        plan.clip = command.scenes.front().stem().string() + (command.drawing.transparent ? ".webm" : ".mp4");
    if (plan.clip) {
        plan.format = video_format(*plan.clip, fps, command.drawing.transparent);
        if (!scenes.frames.contiguous())
            throw InputError(
                fmt::format("--frames-range: a clip needs frames without gaps between them (given '{}'); "
                            "--frames takes any",
                            safe_text(*command.frames_range)));
        find_ffmpeg();
    }
    check_outputs(command, plan, scenes);

    plan.pictures = identity_of(scenes.scenes, drawing_settings(command, choices_of(command), scenes.composition));
    plan.pictures.frames = scenes.clip_frames;
    plan.pictures.fps = fps;
    plan.aovs = identity_of_aovs(plan.pictures, command.aovs);
    if (plan.folder)
        plan.frames.folder = missing_in(command, *plan.folder, FrameFiles::pictures, plan.pictures, scenes.frames);
    if (plan.aov_folder)
        plan.frames.aovs = missing_in(command, *plan.aov_folder, FrameFiles::aovs, plan.aovs, scenes.frames);
    if (plan.clip) plan.frames.video = scenes.frames;
    if (plan.clip && command.resume) {
        const ClipPicture picture{scenes.composition.width, scenes.composition.height, fps};
        plan.segments =
            std::make_unique<SegmentedClip>(*plan.clip, picture, plan.clip_options, plan.pictures, scenes.frames);
        plan.frames.video = plan.segments->missing();
    }
    plan.frames.drawn = plan.frames.folder.united_with(plan.frames.aovs).united_with(plan.frames.video);
    // Damage is drawn relative to the frame before, so that all earlier ones are drawn.
    if (scenes.shows_damage() && !plan.frames.drawn.empty() && command.start == 0.0)
        plan.frames.drawn = {0, plan.frames.drawn.end()};
    return plan;
}

}  // namespace tumble
