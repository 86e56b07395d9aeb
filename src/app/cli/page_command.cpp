#include "app/cli/command.h"
#include "app/cli/export_command.h"
#include "app/cli/page_clip.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/output_plan.h"
#include "app/page/live_controls.h"
#include "core/error.h"
#include "core/html_text.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"
#include "page/page_shell.h"
#include "page/player_figure.h"
#include "page/run_html.h"
#include "page/web_folder.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace tumble {
namespace {

namespace fs = std::filesystem;

struct PageCommand {
    std::vector<std::filesystem::path> scenes;    // a run for each
    std::vector<std::string> vary;                // "PATH=VALUE,VALUE": a run for each
    std::vector<std::string> labels;              // of the runs; empty: made from the names and values
    std::optional<std::filesystem::path> output;  // without this, the first scene's name with .html
    SceneOverrides overrides;
    std::optional<std::string> title;  // without this, the first scene's
    std::optional<std::string> language;
    std::string compare;                  // of runs: single, ghost, side-by-side; empty: single
    std::string follow;                   // body that the camera follows
    double time = 0.0;                    // s, shown at first
    bool film = true;                     // in the page, for readers without WebGL
    int film_width = 0, film_height = 0;  // pixels; 0: 640 at most, with the scene's aspect
    bool embed_glb = false;
    std::optional<std::vector<std::string>> live;  // values to change, of a live page
    int threads = 1;
    int workers = 1;  // render processes of the film
    bool quiet = false;
};

constexpr int film_side = 640, side_of_panels = 960;  // pixels, the longer one of the film
constexpr const char* clip_id = "clip-1";

/// The simulation of a page has no files, and its command has no other options than --set.
void check_live(const PageCommand& command, const PageScenes& scenes) {
    const auto scene_file = command.scenes.front().lexically_normal();
    for (const fs::path& file : scenes.inputs)
        if (file.lexically_normal() != scene_file)
            throw InputError(fmt::format("--live: a live page has no files, and the scene reads {}", safe_path(file)));
    const SceneOverrides& o = command.overrides;
    if (o.duration || o.fps || o.method || o.integrator || o.camera || o.overlay || o.plot)
        throw InputError(
            "--live: give --duration, --fps, --method, --integrator, --camera, --overlay and --plot in the scene, or "
            "by "
            "--set, as --set simulation.duration=2");
}

LivePage live_page(const PageCommand& command, const PageScenes& scenes) {
    LivePage page;
    page.name = scenes.sources.front().name;
    page.settings = command.overrides.set;
    for (const std::string& text : *command.live) page.controls.push_back(parse_live_control(text));
    complete_live_controls(page.controls, scenes.sources.front().text, command.scenes.front(), command.overrides);
    return page;
}

void check_command(const PageCommand& command, const PageScenes& scenes) {
    const SceneDescription& first = scenes.scenes.front();
    if (!command.follow.empty() &&
        std::ranges::none_of(first.bodies, [&](const auto& body) { return body.name == command.follow; }))
        throw InputError(
            fmt::format("--follow: {} has no body '{}'", safe_path(first.file), safe_text(command.follow)));
    if (command.time > scenes.duration())
        throw InputError(fmt::format("--time: the clip lasts {:g} s (given {:g})", scenes.duration(), command.time));
    if (!command.compare.empty() && scenes.scenes.size() < 2)
        throw InputError("--compare: needs two runs or more: give several scenes, or --vary (given one run)");
    if (command.live && scenes.scenes.size() > 1)
        throw InputError(fmt::format("--live: needs a single run (given {})", scenes.scenes.size()));
    if (command.live) check_live(command, scenes);
    if (command.embed_glb && scenes.scenes.size() > 1)
        throw InputError(fmt::format("--embed-glb: needs a single run (given {})", scenes.scenes.size()));
}

PageFilm film_of(const PageCommand& command, const PageScenes& scenes) {
    RenderCommand render;
    render.scenes = command.scenes;
    render.vary = command.vary;
    render.labels = command.labels;
    render.overrides = command.overrides;
    render.overrides.plot = "none";  // the player shows plots without WebGL, too
    render.threads = command.threads;
    render.workers = command.workers;
    render.quiet = command.quiet;
    set_film_size(render.overrides, scenes.scenes.front(), scenes.scenes.size() > 1 ? side_of_panels : film_side);
    if (command.film_width > 0) {
        render.overrides.width = command.film_width;
        render.overrides.height = command.film_height;
    }
    return draw_film(std::move(render), {command.film, scenes.scenes.front().output.fps, scenes.duration()});
}

/// A link that saves the clip as a file.
std::string download_html(const PageCommand& command, const PageScenes& scenes) {
    Interrupt interrupt;
    const ExportedScene exported =
        export_scene(scenes.scenes.front(), KeyKind::cubic, command.threads, command.quiet, interrupt);
    return fmt::format(
        "<a download=\"{}.glb\" href=\"{}\">Download the clip as glTF</a> for Blender and other "
        "3D "
        "programs ({:.0f}&#8239;kB)",
        html_text(command.scenes.front().stem().string()), data_address("model/gltf-binary", exported.bytes),
        1e-3 * double(exported.bytes.size()));
}

std::string body_html(const PageCommand& command, const PageScenes& scenes, const PageClip& clip, const PageFilm& film,
                      const std::optional<LivePage>& live) {
    const PageRun& run = clip.runs.front();
    PlayerFigure figure;
    figure.clip = clip_id;
    figure.poster = film.poster;
    figure.film = film.film;
    figure.width = film.width;
    figure.height = film.height;
    figure.options.layout = "page";
    figure.options.time = command.time;
    figure.options.follow = command.follow;
    figure.options.compare = command.compare;
    figure.options.alt = summary_of(run);
    if (live) figure.live = live_json(*live);
    if (command.embed_glb) figure.caption_html = download_html(command, scenes);
    std::string html = masthead_html(clip.title, "", summary_of(run)) + figure_html(figure);
    // The player shows the sources itself.
    html += "<section class=\"without-player\" aria-label=\"Scene\">\n<h2>Scene</h2>\n" + sources_html(clip.sources) +
            "</section>\n";
    return html;
}

void run_page(const PageCommand& command) {
    const PageScenes scenes = load_page_scenes(command.scenes, command.overrides, command.vary, command.labels);
    check_command(command, scenes);
    const fs::path output = command.output.value_or(command.scenes.front().stem().string() + ".html");
    OutputPlan plan;
    plan.add_inputs(scenes.inputs);
    const std::optional<LivePage> live = command.live ? std::optional(live_page(command, scenes)) : std::nullopt;
    const PageTemplate page_template(find_web_folder(), live ? PageKind::live : PageKind::recorded);
    plan.add_input(page_template.file());
    plan.add("-o", output);

    TemporaryFile file(output);
    const PageFilm film = film_of(command, scenes);
    PageClip clip;
    {
        Interrupt interrupt;
        clip = record_page(scenes, command.threads, command.quiet, interrupt);
    }
    if (command.title) clip.title = *command.title;
    const ClipData data = make_clip_data(clip);
    PageShell shell;
    shell.title = clip.title;
    shell.language = command.language;
    shell.description = fmt::format("{}: a clip to turn and scrub ({})", clip.title, summary_of(clip.runs.front()));
    shell.generator = clip.generator;
    shell.clips = {{clip_id, data.bytes}};
    shell.body_html = body_html(command, scenes, clip, film, live);
    const std::string page = page_template.fill(shell);
    file.write(page);
    file.commit();
    if (!command.quiet)
        say("wrote {} ({:.4g} kB: data {:.4g} kB, film and picture {:.4g} kB; errors of the motion up to {:.2g} m, "
            "{:.2g} "
            "rad)\n",
            safe_path(output), 1e-3 * double(page.size()), 1e-3 * double(base64_length(data.bytes.size())),
            1e-3 * double(film.film.size() + film.poster.size()), data.errors.position, data.errors.rotation);
}

}  // namespace

void add_page(Command& command) {
    PageCommand& c = command.keep<PageCommand>();
    command.add_option("scene", c.scenes, "The scene files (TOML); several are runs to choose from and compare")
        ->check(file_name("toml"))
        ->required()
        ->type_name("SCENE");
    command
        .add_option("-o,--output", c.output,
                    "The page to write, one file that needs no network; without this the first\n"
                    "scene's name with .html, in this folder")
        ->check(file_name("html"))
        ->type_name("PAGE.html");
    add_vary(command, c.vary, "A run");
    command
        .add_option("--label", c.labels,
                    "Name of a run, in place of its varied values; once for each run, in their order")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("TEXT");
    add_choice<std::string>(command, "--compare", c.compare,
                            {{"single", "single"}, {"ghost", "ghost"}, {"side-by-side", "side-by-side"}},
                            "How the page shows several runs at first: one, the others as ghosts, or all");
    command
        .add_option_function<std::vector<std::string>>(
            "--live",
            [&c](const std::vector<std::string>& texts) {
                c.live.emplace();
                for (const std::string& text : texts)
                    if (!text.empty() && text != "{}") c.live->push_back(text);  // CLI11's texts of an option alone
            },
            "A live page: the reader changes these values, or the scene's text, and the page\n"
            "simulates again. KEY is a key of --set; its slider has the range MIN:MAX:STEP, or\n"
            "one around the scene's value; VALUE,VALUE is a choice")
        ->expected(0, -1)
        ->type_name("KEY[=MIN:MAX:STEP|=VALUE,VALUE...]");
    add_frames_of_time(command, c.overrides);
    add_camera(command, c.overrides);
    add_overlay(command, c.overrides,
                "Overlays that the page shows at first, in place of the scene's: none, or a list\nout of");
    command
        .add_option("--plot", c.overrides.plot,
                    "Plots that the page shows at first, as in energy,body.ball.y (names: tumble plot\n--help)")
        ->option_text("LIST [energy]");
    command.add_option("--title", c.title, "Title, in place of the scene's")->type_name("TEXT");
    command
        .add_option("--language", c.language,
                    "Language of the title and of the player: en, de, es or fr; without this the player\n"
                    "has the reader's")
        ->check(some_name())
        ->type_name("CODE");
    command.add_option("--time", c.time, "Moment shown at first")
        ->check(number_within(limits::duration.min, limits::duration.max))
        ->option_text("S [0]");
    command.add_option("--follow", c.follow, "Body that the camera follows at first")->type_name("BODY");
    CLI::Option* no_film = command.add_flag_callback(
        "--no-film", [&c] { c.film = false; }, "No film in the page for readers without WebGL, only a picture");
    command
        .add_option_function<std::string>(
            "--film-size",
            [&c](const std::string& text) { std::tie(c.film_width, c.film_height) = read_size(text, "--film-size"); },
            "Size of that film; by default its longer side has 640 pixels, 960 for several runs")
        ->excludes(no_film)
        ->check(some_name())
        ->type_name("WxH");
    command.add_flag("--embed-glb", c.embed_glb, "The clip as a glTF file within the page, for download");
    c.threads = machine_threads();
    add_workers(command, c.workers, "Render processes of the film; the result is the same for any number");
    add_run(command, c.threads, std::to_string(c.threads), c.quiet);
    command.notes = "Pages need the player, which scripts/build-web builds once.";
    command.examples =
        "  tumble page scene.toml                            writes scene.html\n"
        "  tumble page scene.toml --vary materials.ball.restitution=0.2,0.5,0.8 --compare ghost\n"
        "  tumble page scene.toml -o ball.html --overlay velocity,forces --plot body.ball.y,energy\n"
        "  tumble page scene.toml --live body.ball.restitution simulation.gravity.1=-20:0:0.1\n"
        "  tumble page scene.toml --set simulation.impacts=exact   exact between frames too";
    command.logs = true;
    command.run = [&c] {
        run_page(c);
        return 0;
    };
}

}  // namespace tumble
