#include "app/cli/golden_drawing.h"

#include "app/cli/commands.h"
#include "app/cli/render_run.h"
#include "app/clip/render_scenes.h"
#include "app/files/frame_folder.h"
#include "app/plots/variants.h"
#include "core/error.h"
#include "scene/hash/scene_hash.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr int plot_width = 900, plot_height = 540;  // pixels, of a plot without a size

RenderCommand render_command(const GoldenCase& golden) {
    RenderCommand command;
    command.scenes = golden.scenes;
    command.vary = golden.vary;
    command.overrides = golden.overrides;
    command.arrangement = golden.arrangement;
    command.drawing.transparent = golden.transparent;
    command.speed = golden.speed;
    command.shutter = golden.shutter;
    command.blur_samples = golden.blur_samples;
    command.quiet = true;
    return command;
}

PlotCommand plot_command(const GoldenCase& golden) {
    PlotCommand command;
    command.scenes = golden.scenes;
    command.vary = golden.vary;
    command.overrides = golden.overrides;
    command.overrides.width.reset();
    command.overrides.height.reset();
    command.width = golden.overrides.width.value_or(plot_width);
    command.height = golden.overrides.height.value_or(plot_height);
    command.quantities = *golden.of;
    command.quiet = true;
    return command;
}

void draw_plot(const GoldenCase& golden, const fs::path& folder, const DrawingWork& work) {
    PlotCommand command = plot_command(golden);
    command.output = folder / golden.image_name(0);
    command.motion_record = folder / golden.record_name();
    command.threads = work.threads;
    run_plot(command);
}

/// "0,44-45,89-90", with or without the frame before each one.
std::string range_of(const std::vector<std::int64_t>& frames, bool with_neighbors) {
    std::string range;
    std::int64_t end = 0;  // one after the last frame in it
    for (const std::int64_t frame : frames) {
        const std::int64_t first = std::max(with_neighbors ? frame - 1 : frame, end);
        const char* const comma = range.empty() ? "" : ",";
        range += first < frame ? fmt::format("{}{}-{}", comma, first, frame) : fmt::format("{}{}", comma, frame);
        end = frame + 1;
    }
    return range;
}

void draw_frames(const GoldenCase& golden, const std::vector<std::int64_t>& frames, const fs::path& folder,
                 const DrawingWork& work) {
    RenderCommand command = render_command(golden);
    command.frames = folder / "frames";
    command.motion_record = folder / golden.record_name();
    command.workers = work.workers;
    command.threads = work.threads;
    // Dirty regions are those since the frame before, which is drawn as well.
    const bool all = RenderScenes(command, Shutter::of(command.shutter, command.blur_samples)).shows_damage();
    command.frames_range = all ? fmt::format("0-{}", frames.back()) : range_of(frames, work.neighbors);
    render_to_files(command);
    for (const std::int64_t frame : frames)
        fs::rename(frame_path(*command.frames, frame), folder / golden.image_name(frame));
    fs::remove_all(*command.frames);
}

}  // namespace

std::string SceneDrawer::identity(const GoldenCase& golden) const {
    std::string text = fmt::format("{} {} {} {} {}\n", golden.of.value_or("-"), golden.transparent, golden.speed,
                                   golden.shutter, golden.blur_samples);
    if (golden.of) {
        const PlotCommand command = plot_command(golden);
        text += fmt::format("{} {}\n", command.width, command.height);
        for (const Variant& variant : make_variants(command.scenes, command.overrides, command.vary))
            text += fmt::format("{} {}\n", scene_hash(load_scene(variant.scene, variant.overrides)), variant.label);
        return text;
    }
    const RenderCommand command = render_command(golden);
    const RenderScenes scenes(command, Shutter::of(command.shutter, command.blur_samples));
    for (const ClipScene& one : scenes.scenes) text += fmt::format("{} {}\n", scene_hash(*one.scene), one.label);
    return text + fmt::format("{}\n", int(golden.arrangement));
}

void SceneDrawer::draw(const GoldenCase& golden, const std::vector<std::int64_t>& frames, const fs::path& folder,
                       const DrawingWork& work) const {
    if (golden.of)
        draw_plot(golden, folder, work);
    else
        draw_frames(golden, frames, folder, work);
}

}  // namespace tumble
