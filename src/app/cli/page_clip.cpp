#include "app/cli/page_clip.h"

#include "app/cli/progress.h"
#include "app/cli/render_run.h"
#include "app/cli/say.h"
#include "app/files/frame_folder.h"
#include "app/page/record_run.h"
#include "app/plots/alike_runs.h"
#include "core/error.h"
#include "core/frame_rate.h"
#include "core/html_text.h"
#include "core/input_file.h"
#include "core/safe_text.h"
#include "output/process.h"
#include "output/temporary_folder.h"
#include "presimulation/impact_focus.h"
#include "quantities/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The options of the command line that change the scenes, one a line; empty: none.
std::string options_text(const SceneOverrides& overrides, std::span<const std::string> vary) {
    std::string text;
    const auto add = [&](const char* option, const auto& value) {
        if (value) text += fmt::format("{} {}\n", option, *value);
    };
    add("--method", overrides.method);
    add("--integrator", overrides.integrator);
    add("--duration", overrides.duration);
    if (overrides.fps) text += fmt::format("--fps {}\n", fps_text(*overrides.fps));
    for (const std::string& value : overrides.set) text += fmt::format("--set {}\n", value);
    for (const std::string& values : vary) text += fmt::format("--vary {}\n", values);
    add("--camera", overrides.camera);
    add("--overlay", overrides.overlay);
    add("--plot", overrides.plot);
    return text;
}

void check_plot(const SceneDescription& scene, const SceneOverrides& overrides) {
    try {
        if (!scene.overlay.plot.empty()) parse_quantities(scene.overlay.plot, scene);
    } catch (const InputError& error) {
        if (overrides.plot) throw InputError(fmt::format("--plot: {}", error.message()));
        throw InputError({scene.file, 0, 0}, fmt::format("[overlay] plot: {}", error.message()));
    }
}

constexpr double most_fps = 30.0;            // of the film; more doubles its bytes
constexpr double poster_place = 1.0 / 3.0;   // of the clip: bodies are in motion, and near their start
constexpr const char* poster_quality = "3";  // of ffmpeg's JPEG, 2 (best) to 31

std::string address_of(const fs::path& file, const char* media_type) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    if (!stream) throw RunError(fmt::format("cannot read {}", safe_path(file)));
    return data_address(media_type, std::as_bytes(std::span(bytes.view())));
}

/// The picture of a film at a time, or a picture in another format, as JPEG.
void make_jpeg(const fs::path& ffmpeg, const fs::path& from, double time, const fs::path& jpeg) {
    Process process(ffmpeg, {"-hide_banner",
                             "-nostdin",
                             "-loglevel",
                             "error",
                             "-y",
                             "-ss",
                             fmt::format("{:.6f}", time),
                             "-threads",
                             "1",
                             "-i",
                             "file:" + from.string(),
                             "-frames:v",
                             "1",
                             "-q:v",
                             poster_quality,
                             "-pix_fmt",
                             "yuvj420p",
                             "-fflags",
                             "+bitexact",
                             "-flags:v",
                             "+bitexact",
                             "-f",
                             "mjpeg",
                             "file:" + jpeg.string()});
    const ProcessEnd end = process.finish();
    if (!end.ok() || !fs::exists(jpeg))
        throw RunError(fmt::format("ffmpeg did not make the picture of the page: {}\n{}", end.describe(),
                                   safe_lines(end.error_text)));
}

/// The time of the poster's frame, s of the clip.
double poster_time(double duration, double fps) { return std::floor(poster_place * duration * fps + 1e-9) / fps; }

}  // namespace

double PageScenes::duration() const {
    double longest = 0.0;
    for (const SceneDescription& scene : scenes) longest = std::max(longest, scene.simulation.duration);
    return longest;
}

std::string PageScenes::title() const {
    const std::string& given = scenes.front().title;
    return given.empty() ? variants.front().scene.stem().string() : given;
}

PageScenes load_page_scenes(std::span<const fs::path> files, const SceneOverrides& overrides,
                            std::span<const std::string> vary, std::span<const std::string> labels) {
    PageScenes page;
    page.vary.assign(vary.begin(), vary.end());
    page.variants = make_variants(files, overrides, vary);
    try {
        label_variants(page.variants, labels);
    } catch (const InputError& error) {
        throw InputError(fmt::format("--label: {}", error.message()));
    }
    for (const Variant& variant : page.variants) {
        page.scenes.push_back(focused_on_impacts(load_scene(variant.scene, variant.overrides, &page.inputs)));
        check_plot(page.scenes.back(), overrides);
    }
    for (const fs::path& file : files)
        page.sources.push_back({file.filename().string(), read_input_file(file, "the scene")});
    const std::string options = options_text(overrides, vary);
    if (!options.empty()) page.sources.push_back({"Options of the command line", options});
    return page;
}

PageClip record_page(const PageScenes& scenes, int threads, bool quiet, Interrupt& interrupt) {
    PageClip clip;
    clip.title = scenes.title();
    clip.generator = "Tumble " TUMBLE_VERSION;
    clip.sources = scenes.sources;
    std::int64_t total = 0, before = 0;
    for (const SceneDescription& scene : scenes.scenes) total += scene.frame_count();
    Progress progress(total, quiet);
    AlikeRuns alike(scenes.vary);
    for (std::size_t i = 0; i < scenes.scenes.size(); ++i) {
        RecordSettings settings;
        settings.threads = threads;
        settings.label = scenes.variants[i].label;
        settings.plot = scenes.scenes[i].overlay.plot;
        if (!scenes.vary.empty()) settings.observers.push_back(&alike.add(settings.label, scenes.scenes[i]));
        settings.progress = [&](std::int64_t done) { progress.update(before + done); };
        clip.runs.push_back(record_run(scenes.scenes[i], settings, interrupt));
        before += scenes.scenes[i].frame_count();
    }
    if (!quiet) say_text(alike.warning());
    return clip;
}

void set_film_size(SceneOverrides& overrides, const SceneDescription& scene, int longest) {
    const double width = scene.output.width, height = scene.output.height;
    const double scale = std::min(1.0, longest / std::max(width, height));
    const auto even = [](double side) { return std::max(2, 2 * int(std::lround(0.5 * side))); };
    overrides.width = even(scale * width);
    overrides.height = even(scale * height);
}

PageFilm draw_film(RenderCommand command, const FilmOptions& options) {
    const TemporaryFolder folder("page");
    const std::optional<fs::path> ffmpeg = find_program("ffmpeg");
    command.clip.reset();
    command.report.reset();
    command.frames.reset();
    command.aovs = {};
    command.aov_folder.reset();
    command.drawing.transparent = false;
    command.own_speed = false;  // the player has the scene's own time
    command.clip_options = {FrameTimes::constant_rate, VideoQuality::small};
    const fs::path jpeg = folder.path() / "poster.jpg";
    PageFilm made;
    RenderFigures figures;
    if (options.with_film && ffmpeg) {
        command.clip = folder.path() / "film.mp4";
        command.frame_step = std::max(1, int(std::ceil(options.fps / most_fps - 1e-9)));
        figures = render_to_files(command);
        make_jpeg(*ffmpeg, *command.clip, poster_time(double(figures.frames.count() - 1) / figures.fps, figures.fps),
                  jpeg);
        made.film = address_of(*command.clip, "video/mp4");
    } else {
        command.frames = folder.path();
        command.start = poster_time(options.duration, options.fps);
        command.overrides.duration = command.start;
        figures = render_to_files(command);
        const fs::path png = frame_path(folder.path(), figures.frames.first());
        if (!ffmpeg) made.poster = address_of(png, "image/png");
        if (ffmpeg) make_jpeg(*ffmpeg, png, 0.0, jpeg);
    }
    if (ffmpeg) made.poster = address_of(jpeg, "image/jpeg");
    made.width = figures.width;
    made.height = figures.height;
    if (options.with_film && !ffmpeg && !command.quiet)
        say("note: the page has no film, because the ffmpeg program is not on the PATH (apt-get install ffmpeg)\n");
    return made;
}

}  // namespace tumble
