#include "app/cli/render_command.h"

#include "app/cli/command.h"
#include "app/cli/render_report.h"
#include "app/cli/render_run.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/aov_folder.h"
#include "app/files/frame_folder.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "scene/load.h"
#include "scene/toml/limits.h"
#include "scene/toml/set_values.h"
#include "scene/toml/toml_reader.h"
#include "sim/frames/clip_timing.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

namespace {

constexpr const char* every = "all";
constexpr const char* own_folder = "camera";  // of [camera]

/// The names of [cameras] in a scene file, sorted.
std::vector<std::string> names_of_cameras(const RenderCommand& command) {
    const std::filesystem::path& file = command.scenes.front();
    toml::table document = parse_toml(read_scene_text(file), file.string());
    set_values(document, command.overrides.set);
    std::vector<std::string> names;
    if (const toml::table* cameras = document["cameras"].as_table())
        for (const auto& [name, value] : *cameras) names.emplace_back(name.str());
    std::ranges::sort(names);
    return names;
}

void check(const RenderCommand& command, const std::vector<std::string>& names) {
    if (command.scenes.size() > 1 || !command.vary.empty())
        throw InputError("--camera all: needs a single scene, without --vary");
    if (!command.frames && !command.aov_folder)
        throw InputError("--camera all: needs --frames or --aov-folder for the folders of the cameras");
    if (command.clip || command.report || command.motion_record || command.profile || command.from_checkpoints)
        throw InputError(
            "--camera all: writes frames and AOVs alone; leave --output, --report, --motion-record, --profile and "
            "--from-checkpoints out, or name one camera");
    for (const std::string& name : names) {
        const bool no_folder = name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos ||
                               name.find('\0') != std::string::npos;
        if (no_folder || name == own_folder)
            throw InputError(
                fmt::format("--camera all: [cameras.\"{}\"] {}; give it another name", safe_text(name),
                            no_folder ? "cannot be the name of a folder" : "would have the folder of [camera]"));
    }
}

}  // namespace

std::vector<RenderCommand> of_each_camera(const RenderCommand& command) {
    if (command.overrides.camera != every) return {command};
    const std::vector<std::string> names = names_of_cameras(command);
    if (std::ranges::find(names, every) != names.end()) return {command};  // a camera of that name
    check(command, names);
    std::vector<RenderCommand> commands;
    const auto add = [&](const std::optional<std::string>& camera, const std::string& folder) {
        RenderCommand& one = commands.emplace_back(command);
        one.overrides.camera = camera;
        if (one.frames) one.frames = *one.frames / folder;
        if (one.aov_folder) one.aov_folder = *one.aov_folder / folder;
    };
    add(std::nullopt, own_folder);
    for (const std::string& name : names) add(name, name);
    return commands;
}

namespace {

namespace fs = std::filesystem;

std::string frame_step_note(const RenderFigures& done) {
    if (done.frames_in_clip == done.frames.count()) return "";
    return fmt::format(" (one in {} of {}: the format holds no more)", done.frame_step, done.frames.count());
}

std::string stored(const RenderFigures& done) {
    if (done.frames_stored == done.frames_in_clip) return "";
    return fmt::format(", stored as {} (unchanged pictures are shown longer)", done.frames_stored);
}

void print_times(const RenderFigures& done) {
    std::string text =
        fmt::format("{:.2f} s, {:.1f} frames/s; {} drawn; CPU: simulation {:.2f} s, drawing {:.2f} s", done.seconds,
                    double(done.rendered) / done.seconds, done.drawn, done.cpu.simulation, done.cpu.drawing);
    if (done.folder) text += fmt::format(", PNG {:.2f} s", done.cpu.png);
    if (done.aov_folder) text += fmt::format(", AOVs {:.2f} s", done.cpu.aovs);
    if (done.clip) text += fmt::format(", conversion {:.2f} s, video {:.2f} s", done.cpu.conversion, done.cpu.video);
    say("{}; peak memory {} MiB\n", text, done.peak_memory);
}

/// Warns of frames of an earlier, longer clip, because `tumble encode` would append them to this one.
void print_older(const RenderFigures& done, const char* what, const std::vector<std::int64_t>& there,
                 const fs::path& where, fs::path (&path)(const fs::path&, std::int64_t)) {
    const auto older = std::lower_bound(there.begin(), there.end(), done.clip_frames);
    if (older != there.end())
        say("note: {} older {} are still in the folder, from {} on\n", there.end() - older, what,
            safe_path(path(where, *older)));
}

/// The same for programs.
void log_summary(const RenderFigures& done) {
    nlohmann::ordered_json wrote = nlohmann::ordered_json::object();
    if (done.clip) wrote["clip"] = done.clip->string();
    if (done.folder) wrote["frames"] = done.folder->string();
    if (done.aov_folder) wrote["aovs"] = done.aov_folder->string();
    wrote.update({{"width", done.width}, {"height", done.height}, {"fps", done.fps}, {"count", done.frames.count()}});
    if (done.clip) {
        const ImageSize size = stored_size(done.kind, {done.width, done.height});
        wrote.update({{"clip_width", size.width}, {"clip_height", size.height}});
    }
    messages().event("wrote", wrote);
    messages().event("times", {{"seconds", done.seconds},
                               {"cpu",
                                {{"simulation", done.cpu.simulation},
                                 {"drawing", done.cpu.drawing},
                                 {"png", done.cpu.png},
                                 {"aovs", done.cpu.aovs},
                                 {"conversion", done.cpu.conversion},
                                 {"video", done.cpu.video}}},
                               {"peak_memory", done.peak_memory},
                               {"drawn", done.drawn},
                               {"workers", done.workers},
                               {"threads", done.threads}});
}

void print_summary(const RenderFigures& done, const AovSet& aovs) {
    if (messages().json()) return log_summary(done);
    const std::int64_t first = done.frames.first(), last = done.frames.last();
    if (done.clip)
        say("wrote {}: {} frames of {}{}{}\n", safe_path(*done.clip), done.frames_in_clip,
            size_text(done.kind, {done.width, done.height}), frame_step_note(done), stored(done));
    if (done.folder)
        say("wrote {} to {}\n", safe_path(frame_path(*done.folder, first)),
            frame_path(*done.folder, last).filename().string());
    if (done.aov_folder)
        say("wrote {} to {}: {}\n", safe_path(aov_path(*done.aov_folder, first)),
            aov_path(*done.aov_folder, last).filename().string(), names_of(aovs));
    if (done.rendered < done.frames.count())
        say("kept {} of {} frames from an earlier run\n", done.frames.count() - done.rendered, done.frames.count());
    if (done.rendered > 0) print_times(done);
    if (done.folder) print_older(done, "frames", frames_in(*done.folder), *done.folder, frame_path);
    if (done.aov_folder) print_older(done, "AOVs", aovs_in(*done.aov_folder), *done.aov_folder, aov_path);
}

/// Frames in a folder carry the mark of their clip, so that any run with --frames can be continued.
std::string how_to_go_on(const RenderCommand& command) {
    const bool continues = command.resume || command.frames || command.aov_folder;
    if (!continues) return "";
    return fmt::format("; finished {} are kept. To go on:\n  {}{}",
                       command.frames || command.aov_folder ? "frames" : "segments",
                       command.call.empty() ? "the same command" : command.call,
                       command.resume         ? ""
                       : command.call.empty() ? " with --resume"
                                              : " --resume");
}

constexpr const char* aov_list = "depth,normal,segmentation,motion,albedo";

/// "depth,normal" to a set.
AovSet read_aovs(const std::string& text) {
    AovSet aovs, all;
    std::vector<std::string_view> aov_names;
    for (const Aov aov : all_aovs) {
        all.add(aov);
        aov_names.push_back(name_of(aov));
    }
    for (std::size_t first = 0; first <= text.size();) {
        const std::size_t end = std::min(text.find(',', first), text.size());
        const std::string name = text.substr(first, end - first);
        const std::optional<Aov> aov = aov_named(name);
        if (!aov)
            throw InputError(fmt::format("--aov: unknown name '{}' (known: {}){}", safe_text(name), names_of(all),
                                         did_you_mean(name, aov_names)));
        aovs.add(*aov);
        first = end + 1;
    }
    return aovs;
}

void run_one(const RenderCommand& command) {
    std::optional<RenderReport> report;
    if (command.report) report.emplace(command);
    RenderFigures done;
    try {
        done = render_to_files(command);
    } catch (const Interrupted& interrupted) {
        throw RunError(interrupted.message() + how_to_go_on(command));
    }
    if (!command.quiet) print_summary(done, command.aovs);
    if (report) report->write(done);
}

void run_render(const RenderCommand& command) {
    for (const RenderCommand& one : of_each_camera(command)) run_one(one);
}

}  // namespace

void add_panels(CLI::App& command, RenderCommand& clip, const std::string& what) {
    add_vary(command, clip.vary, what);
    add_choice<PanelArrangement>(command, "--layout", clip.arrangement,
                                 {{"row", PanelArrangement::row}, {"grid", PanelArrangement::grid}},
                                 "Arrangement of several panels; by default up to three are in a row, more in a grid");
}

void add_text(CLI::App& command, SceneOverrides& overrides) {
    add_camera(command, overrides);
    add_overlay(command, overrides, "Overlays of the pictures, in place of the scene's: none, or a list out of");
    command
        .add_option("--plot", overrides.plot,
                    "Curves of quantities in the clip, with a cursor at each frame's time: none, or a list\n"
                    "such as energy,body.ball.y (names: tumble plot --help)")

        ->type_name("LIST");
    offer(command.add_option("--plot-place", overrides.plot_place,
                             "Place of the plot: in a corner, or a third of the picture"),
          "inset|beside|below");
}

void add_clip_times(CLI::App& command, RenderCommand& clip) {
    command
        .add_option("--speed", clip.speed,
                    "Speed of the motion: 0.25 is slow motion (the clip lasts four times as long,\n"
                    "at the same frames per second), 2 twice as fast")
        ->check(number_within(slowest_speed, fastest_speed))
        ->option_text("X [1]");
    command
        .add_option("--shutter", clip.shutter, "Motion blur: how long the shutter is open, 180 for half of each frame")
        ->check(number_within(0.0, 360.0))
        ->option_text("DEGREES [0]");
    command.add_option("--blur-samples", clip.blur_samples, "Moments averaged while the shutter is open")
        ->check(number_within(2, most_blur_samples))
        ->option_text(fmt::format("N [{}]", clip.blur_samples));
}

void add_render_options(CLI::App& command, RenderCommand& c) {
    command.add_option("scene", c.scenes, "The scene files (TOML); several are shown side by side")
        ->check(file_name("toml"))
        ->required()
        ->type_name("SCENE");
    command
        .add_option("-o,--output", c.clip,
                    "The clip to write; its ending chooses the format: .mp4 .mov .mkv (H.264),\n"
                    ".webm (VP9), .gif. Without this, --frames and --aov-folder: the scene's\n"
                    "name with .mp4 (.webm with --transparent), in this folder (of several scenes,\n"
                    "the first one's)")
        ->check(file_name("mp4 mov mkv webm gif"))
        ->type_name("CLIP");
    command.add_option("--frames", c.frames, "Write the frames as DIR/frame_000000.png and so on")
        ->check(folder_name())
        ->type_name("DIR");
    command
        .add_option("--report", c.report,
                    "Write a page about the run: the clip in 3D, energy balance, contacts, times of the\n"
                    "stages, versions and the scene (docs/how-to/reports.md). Without --output and --frames\n"
                    "the clip is written as well")
        ->check(file_name("html"))
        ->type_name("R.html");
    command
        .add_option_function<std::string>(
            "--aov", [&c](const std::string& text) { c.aovs = read_aovs(text); },
            fmt::format("Write AOVs, exact for every pixel: a list out of {}, as DIR/aov_000000.npz and so on, for "
                        "NumPy's np.load (docs/reference/aovs.md)",
                        aov_list))
        ->check(list_of(aov_list))
        ->type_name("LIST");
    command
        .add_option("--profile", c.profile,
                    "Write a trace of the run: which stage worked on which frame when (Chrome trace format,\n"
                    "for ui.perfetto.dev; docs/reference/log.md)")
        ->check(file_name("json"))
        ->type_name("TRACE.json");
    command.add_option("--aov-folder", c.aov_folder, "Folder of the AOVs, in place of that of --frames")
        ->check(folder_name())
        ->type_name("DIR");
    command
        .add_option("--motion-record", c.motion_record,
                    "Write what the frames show (poses, first contacts, camera, light) as a small file, by\n"
                    "which tumble compare names the causes of differences: DIR/frames.motion.json")
        ->check(file_name("json"))
        ->type_name("R.json");
    add_size(command, c.overrides.width, c.overrides.height, "Picture size, in place of the scene's");
    add_frames_of_time(command, c.overrides);
    command
        .add_option("--start", c.start,
                    "Seconds that are simulated and not drawn. Frames keep their numbers and their pixels")
        ->check(number_within(limits::duration.min, limits::duration.max))
        ->option_text("S [0]");
    command
        .add_option("--frames-range", c.frames_range,
                    "Frames that are drawn, by number from 0: 7, 1-10 or 30-40:2, with commas between\n"
                    "them. Earlier frames are simulated. A clip needs frames without gaps")
        ->check(some_name())
        ->type_name("FRAMES");
    command.add_flag("--resume", c.resume,
                     "Keep the finished frames of an earlier run with the same scene, version and settings,\n"
                     "and draw the rest. Clips are written in segments of 0.8 s, in a folder beside them,\n"
                     "so that a run that is ended at any moment loses at most a second\n"
                     "(docs/how-to/long-renders.md)");
    command
        .add_option(
            "--from-checkpoints", c.from_checkpoints,
            "A folder of tumble simulate --checkpoints: the frames before the first drawn one are\nnot simulated again "
            "(docs/how-to/long-renders.md)")
        ->check(folder_name())
        ->excludes("--report")  // which simulates the whole clip
        ->type_name("DIR");
    command
        .add_option("--samples", c.overrides.samples, "Samples per pixel, in place of the scene's: 1 is fast, 4 smooth")
        ->check(number())
        ->type_name("N");
    add_choice<GlBackend>(command, "--gl", c.drawing.backend,
                          {{"software", GlBackend::software}, {"osmesa", GlBackend::osmesa}, {"egl", GlBackend::egl}},
                          "OpenGL backend: software (the default) draws on the CPU, by OSMesa or, where that is "
                          "missing,\nby EGL; egl uses a GPU if there is one. On the CPU all give the same bytes");
    add_clip_times(command, c);
    command.add_flag("--sound", c.sound,
                     "Give the clip the sound of its impacts, of sliding and of rolling, by the bodies' sizes and\n"
                     "their materials (key sound). Slow motion is heard slowly, and lower");
    command.add_flag("--transparent", c.drawing.transparent,
                     "Draw the bodies alone, lit and shadowed as in the scene, on a transparent background:\n"
                     "for slides (.webm, PNG frames) and video editors (.mov, ProRes 4444)");
    add_quality(command, c.clip_options.quality);
    command.add_flag_callback(
        "--variable-rate", [&c] { c.clip_options.times = FrameTimes::longer_frames; },
        "Store an unchanged picture once and show it longer, which costs nothing; players show\n"
        "the same, but tools that count stored frames find fewer");
    add_workers(command, c.workers, "Render processes, one per core; the result is the same for any number");
    add_panels(command, c, "A panel");
    add_text(command, c.overrides);
    add_run(command, c.threads, "by the bodies", c.quiet);
}

void add_render(Command& command) {
    RenderCommand& c = command.keep<RenderCommand>();
    add_render_options(command, c);
    command.examples =
        "  tumble render scene.toml                          writes scene.mp4\n"
        "  tumble render scene.toml -o clip.webm --size 640x360\n"
        "  tumble render scene.toml --frames out             writes out/frame_000000.png ...\n"
        "  tumble render scene.toml --speed 0.25             slow motion\n"
        "  tumble render scene.toml --sound                  with the sound of the impacts\n"
        "  tumble render scene.toml --transparent -o clip.webm   bodies alone, for a slide\n"
        "  tumble render scene.toml --frames one --duration 0  writes the first frame only\n"
        "  tumble render scene.toml --frames one --start 2.5 --duration 2.5   only the one at 2.5 s\n"
        "  tumble render scene.toml --frames out --aov depth,segmentation   and out/aov_000000.npz ...\n"
        "  tumble render scene.toml --aov motion --aov-folder flow          no pictures at all\n"
        "  tumble render scene.toml --frames out --camera all   of each camera, in its own folder\n"
        "  tumble render a.toml b.toml                       side by side in a.mp4\n"
        "  tumble render scene.toml --vary simulation.integrator=explicit-euler,exact --overlay clock\n"
        "  tumble render scene.toml --plot energy --plot-place below\n"
        "  tumble render scene.toml --report report.html     writes scene.mp4 and a page about the run";
    command.logs = true;
    command.run = [&c, &command] {
        c.call = command.call;
        run_render(c);
        return 0;
    };
}

}  // namespace tumble
