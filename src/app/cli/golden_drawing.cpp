#include "app/cli/golden_drawing.h"

#include "app/cli/commands.h"
#include "app/cli/render_run.h"
#include "app/clip/drawing_settings.h"
#include "app/clip/render_scenes.h"
#include "app/files/frame_folder.h"
#include "app/files/frame_set.h"
#include "app/plots/variants.h"
#include "scene/hash/scene_hash.h"

#include <fmt/format.h>

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
    FrameSet set;
    for (const std::int64_t frame : frames)
        set.append(std::max(with_neighbors ? frame - 1 : frame, set.end()), frame + 1);
    return set.text(frames.size());
}

void draw_frames(const GoldenCase& golden, const fs::path& folder, const DrawingWork& work) {
    RenderCommand command = render_command(golden);
    command.frames = folder / "frames";
    command.motion_record = folder / golden.record_name();
    command.workers = work.workers;
    command.threads = work.threads;
    // Dirty regions are those since the frame before, which is drawn as well.
    const bool all = RenderScenes(command, Shutter::of(command.shutter, command.blur_samples)).shows_damage();
    command.frames_range = all ? fmt::format("0-{}", golden.frames.back()) : range_of(golden.frames, work.neighbors);
    render_to_files(command);
    for (const std::int64_t frame : golden.frames)
        fs::rename(frame_path(*command.frames, frame), folder / golden.image_name(frame));
    fs::remove_all(*command.frames);
}

}  // namespace

std::string SceneDrawer::identity(const GoldenCase& golden) const {
    std::string text;
    if (golden.of) {
        const PlotCommand command = plot_command(golden);
        text = fmt::format("{} {} {}\n", command.quantities, command.width, command.height);
        for (const Variant& variant : make_variants(command.scenes, command.overrides, command.vary))
            text += fmt::format("{} {}\n", scene_hash(load_scene(variant.scene, variant.overrides)), variant.label);
        return text;
    }
    const RenderCommand command = render_command(golden);
    const RenderScenes scenes(command, Shutter::of(command.shutter, command.blur_samples));
    for (const ClipScene& one : scenes.scenes) text += fmt::format("{} {}\n", scene_hash(*one.scene), one.label);
    const DrawingChoices choices{golden.shutter, golden.blur_samples, golden.transparent, command.drawing.backend};
    for (const auto& [name, value] : drawing_settings(command, choices, scenes.composition))
        text += fmt::format("{} {}\n", name, value);
    return text;
}

void SceneDrawer::draw(const GoldenCase& golden, const fs::path& folder, const DrawingWork& work) const {
    if (golden.of)
        draw_plot(golden, folder, work);
    else
        draw_frames(golden, folder, work);
}

}  // namespace tumble
