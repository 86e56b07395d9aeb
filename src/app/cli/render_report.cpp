#include "app/cli/render_report.h"

#include "app/cli/driver_check.h"
#include "app/cli/say.h"
#include "app/threads/task_group.h"
#include "core/error.h"
#include "core/frame_rate.h"
#include "core/html_text.h"
#include "core/safe_text.h"
#include "output/process.h"
#include "output/temporary_file.h"
#include "page/player_figure.h"
#include "page/run_html.h"
#include "page/web_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr int report_film_side = 960;    // pixels, the longer one
constexpr double longest_answer = 30.0;  // s for the driver to draw a picture: without caches it takes seconds
constexpr const char* report_clip = "clip-1";

using Pairs = std::vector<std::pair<std::string, std::string>>;

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name"))
            if (const std::size_t colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return "unknown";
}

std::string ffmpeg_version() {
    const std::optional<fs::path> program = find_program("ffmpeg");
    const std::optional<std::string> text = program ? output_of(*program, {"-hide_banner", "-version"}) : std::nullopt;
    return text ? text->substr(0, text->find(" Copyright")) : "missing";
}

std::string versions_html(const RenderCommand& command) {
    TimeLimit limit(longest_answer);
    const Finding driver = try_drawing(command.drawing.backend, limit);
    const Pairs rows = {{"Tumble", TUMBLE_VERSION " (" TUMBLE_BUILD_TYPE ")"},
                        {"compiler", "g++ " __VERSION__},
                        {"OpenGL", driver.good ? driver.text : "unknown"},
                        {"ffmpeg", ffmpeg_version()},
                        {"processor", fmt::format("{}, {} used", processor_name(), machine_threads())}};
    return pairs_html("Programs and machine", rows);
}

std::string times_html(const RenderFigures& done) {
    std::vector<ShareRow> rows = {{"simulation", done.cpu.simulation}, {"drawing", done.cpu.drawing}};
    if (done.clip) {
        rows.push_back({"conversion of colors", done.cpu.conversion});
        rows.push_back({"encoding", done.cpu.video});
    }
    if (done.folder) rows.push_back({"PNG frames", done.cpu.png});
    if (done.aov_folder) rows.push_back({"AOVs", done.cpu.aovs});
    return shares_html("CPU time of the stages, which run at the same time", rows, "s") +
           fmt::format(
               "<p>The render of {} frames, {} of them drawn, took {:.2f}&#8239;s: {:.1f} frames a second with {} "
               "render "
               "process{} and {} thread{} of the simulation, and {} MiB of memory.</p>\n",
               done.rendered, done.drawn, done.seconds, double(done.rendered) / done.seconds, done.workers,
               done.workers == 1 ? "" : "es", done.threads, done.threads == 1 ? "" : "s", done.peak_memory);
}

std::string outputs_html(const RenderFigures& done) {
    Pairs rows;
    const ImageSize size = stored_size(done.kind, {done.width, done.height});
    if (done.clip)
        rows.push_back(
            {"clip", fmt::format("{}: {} frames of {} \u00d7 {} at {} a second", done.clip->filename().string(),
                                 done.frames_in_clip, size.width, size.height, fps_text(done.fps))});
    if (done.folder)
        rows.push_back({"frames", fmt::format("{}: {} of {} \u00d7 {}", done.folder->filename().string(),
                                              done.frames.count(), done.width, done.height)});
    if (done.aov_folder)
        rows.push_back({"AOVs", fmt::format("{}: {}", done.aov_folder->filename().string(), done.frames.count())});
    return pairs_html("Files", rows);
}

}  // namespace

RenderReport::RenderReport(const RenderCommand& command)
    : command_(command),
      scenes_(load_page_scenes(command.scenes, command.overrides, command.vary)),
      template_(find_web_folder()) {}

PageFilm RenderReport::draw() const {
    const FilmOptions options{true, scenes_.scenes.front().output.fps, scenes_.duration()};
    RenderCommand smaller = command_;
    set_film_size(smaller.overrides, scenes_.scenes.front(), report_film_side);
    try {
        return draw_film(smaller, options);
    } catch (const InputError&) {
        return draw_film(command_, options);  // many panels and plots fit into the whole size alone
    }
}

std::string RenderReport::body_html(const PageClip& clip, const ClipData& data, const RenderFigures& done) const {
    const PageFilm film = draw();
    PlayerFigure figure;
    figure.clip = report_clip;
    figure.poster = film.poster;
    figure.film = film.film;
    figure.width = film.width;
    figure.height = film.height;
    figure.options.layout = "page";
    figure.options.alt = summary_of(clip.runs.front());
    figure.options.panels = std::vector<std::string>{"plots", "state", "impacts"};
    if (clip.runs.front().scene.overlay.plot.empty()) figure.options.plot = "energy";

    std::string html = masthead_html(clip.title, "Report of a render", summary_of(clip.runs.front()));
    html += figure_html(figure);
    for (const PageRun& run : clip.runs) {
        if (clip.runs.size() > 1) html += fmt::format("<h2 class=\"run\">{}</h2>\n", html_text(run.label));
        html += key_figures_html(run, data);
        html += fmt::format("<section>\n<h2>Energy balance</h2>\n<div class=\"scroll\">{}</div>\n</section>\n",
                            energy_html(run));
        html += fmt::format("<section>\n<h2>Contacts and impacts</h2>\n{}</section>\n", contacts_html(run));
    }
    html += fmt::format("<section>\n<h2>Time and files</h2>\n{}{}</section>\n", times_html(done), outputs_html(done));
    html += fmt::format("<section>\n<h2>Versions</h2>\n{}</section>\n", versions_html(command_));
    html += fmt::format("<section>\n<h2>Scene</h2>\n{}</section>\n", sources_html(clip.sources));
    return html;
}

void RenderReport::write(const RenderFigures& done) const {
    PageClip clip;
    {
        Interrupt interrupt;
        clip = record_page(scenes_, done.threads, command_.quiet, interrupt);
    }
    const ClipData data = make_clip_data(clip);
    PageShell shell;
    shell.kind = "report";
    shell.title = clip.title + " \u2013 report";
    shell.description = "Report of a render: " + summary_of(clip.runs.front());
    shell.generator = clip.generator;
    shell.clips = {{report_clip, data.bytes}};
    shell.body_html = body_html(clip, data, done);
    const std::string page = template_.fill(shell);
    write_file(*command_.report, page);
    if (!command_.quiet) say("wrote {} ({:.4g} kB)\n", safe_path(*command_.report), 1e-3 * double(page.size()));
}

}  // namespace tumble
