#include "app/cli/command.h"
#include "app/cli/page_clip.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/output_plan.h"
#include "app/lesson/lesson_page.h"
#include "app/lesson/lesson_runs.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_transaction.h"
#include "page/page_shell.h"
#include "page/web_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

namespace tumble {
namespace {

namespace fs = std::filesystem;

struct LessonCommand {
    std::vector<std::filesystem::path> lessons;  // Markdown
    std::filesystem::path site;                  // folder of the pages
    std::string title = "Lessons";               // of the contents
    std::optional<std::string> language;         // of the lessons
    bool check = false;                          // runs and checks everything, and writes nothing
    bool pictures = true;                        // of the stages, for print and for readers without WebGL
    bool films = false;                          // of the stages, for readers without WebGL
    int threads = 1;                             // runs at a time
    int workers = 1;                             // render processes of the pictures
    bool quiet = false;
};

constexpr const char* generator = "Tumble " TUMBLE_VERSION;
constexpr int picture_side = 960;  // pixels, the longer one

struct SitePage {
    std::string name;  // in the folder
    std::string html;
};

constexpr const char* index_name = "index.html";

std::string page_name(const Lesson& lesson) { return lesson.name + ".html"; }

void print_errors(const std::vector<InputError>& errors) {
    for (const InputError& error : errors) say("{}\n", error.what());
}

/// The scene as the stage shows it at first.
SceneOverrides as_shown(const LessonStage& stage, const LoadedScene& loaded) {
    SceneOverrides overrides = loaded.overrides;
    if (stage.options.overlay)
        overrides.overlay =
            stage.options.overlay->empty() ? "none" : fmt::format("{}", fmt::join(*stage.options.overlay, ","));
    overrides.plot = "none";
    if (stage.options.view) {
        const auto vector = [](const Vec3& v) { return fmt::format("[{},{},{}]", v.x(), v.y(), v.z()); };
        overrides.set.push_back("camera.eye=" + vector(stage.options.view->eye));
        overrides.set.push_back("camera.target=" + vector(stage.options.view->target));
    }
    set_film_size(overrides, loaded.scene, picture_side);
    return overrides;
}

StagePictures draw_stage(const LessonCommand& command, const LessonStage& stage,
                         const std::vector<LoadedScene>& scenes) {
    if (!command.pictures) return {};
    const LoadedScene& shown = scenes[std::size_t(stage.options.run)];
    RenderCommand render;
    render.scenes = {stage.scene.file};
    render.text = stage.scene.text;
    render.overrides = as_shown(stage, shown);
    render.threads = command.threads;
    render.workers = command.workers;
    render.quiet = true;
    const PageFilm film =
        draw_film(std::move(render), {command.films, shown.scene.output.fps, shown.scene.simulation.duration});
    return {film.poster, film.film, film.width, film.height};
}

struct LessonTemplates {
    PageTemplate page;
    std::optional<PageTemplate> live;  // where a lesson has live stages, and their simulation is built
};

LessonTemplates read_templates(const fs::path& web, const Course& course, bool quiet) {
    LessonTemplates templates{PageTemplate(web), std::nullopt};
    const bool any = std::ranges::any_of(course.lessons, [](const Lesson& lesson) {
        return std::ranges::any_of(lesson.stages, [](const LessonStage& stage) { return !stage.live.empty(); });
    });
    if (!any) return templates;
    try {
        templates.live.emplace(web, PageKind::live);
    } catch (const RunError& error) {
        if (!quiet) say("note: live stages of the lessons show their recorded runs only: {}\n", error.message());
    }
    return templates;
}

std::vector<SitePage> make_pages(const LessonCommand& command, const Course& course, const LessonRuns& runs,
                                 const LessonTemplates& templates) {
    std::vector<SitePage> pages;
    std::vector<std::string> posters;
    for (std::size_t i = 0; i < course.lessons.size(); ++i) {
        const Lesson& lesson = course.lessons[i];
        std::vector<StagePictures> pictures;
        for (std::size_t s = 0; s < lesson.stages.size(); ++s)
            pictures.push_back(draw_stage(command, lesson.stages[s], runs.scenes()[i].stages[s]));
        if (command.check) continue;
        posters.push_back(pictures.empty() ? std::string() : pictures.front().poster);
        const std::vector<std::vector<LiveControl>> recorded(lesson.stages.size());
        const auto& live = templates.live ? runs.scenes()[i].live : recorded;
        PageShell shell = lesson_page(course, i, {runs.results()[i], pictures, live}, generator);
        shell.language = command.language;
        pages.push_back({page_name(lesson), (shell.live ? *templates.live : templates.page).fill(shell)});
    }
    if (command.check) return pages;
    PageShell index = index_page(course, command.title, generator, posters);
    index.language = command.language;
    pages.push_back({index_name, templates.page.fill(index)});
    return pages;
}

void write_pages(const LessonCommand& command, const std::vector<SitePage>& pages) {
    FileTransaction files(command.site);
    for (const SitePage& page : pages) files.add(page.name, page.html);
    files.commit();
    if (command.quiet) return;
    for (const SitePage& page : pages)
        say("wrote {} ({:.4g} kB)\n", safe_path(command.site / page.name), 1e-3 * double(page.html.size()));
}

void plan_outputs(const LessonCommand& command, const Course& course, const LessonRuns& runs, const fs::path& shell) {
    if (command.check) return;
    OutputPlan plan;
    plan.add_input(shell);
    plan.add_inputs(command.lessons);
    plan.add_inputs(runs.inputs());
    for (const Lesson& lesson : course.lessons) plan.add_below("-o", command.site, page_name(lesson));
    plan.add_below("-o", command.site, index_name);
}

int run_lesson(const LessonCommand& command) {
    if (command.site.empty() && !command.check)
        throw InputError("-o: give the folder of the pages, as in -o site (or --check to write nothing)");
    for (const fs::path& lesson : command.lessons)
        if (!fs::is_regular_file(lesson)) throw InputError(fmt::format("there is no file {}", safe_path(lesson)));
    const fs::path web = find_web_folder();
    const Course course = compile_lessons(command.lessons, web);
    print_errors(course.errors);
    if (!course.errors.empty()) return 2;
    const LessonTemplates templates = read_templates(web, course, command.quiet);

    LessonRuns runs(course, generator);
    plan_outputs(command, course, runs, templates.page.file());
    if (runs.errors().empty()) {
        Progress progress(std::int64_t(runs.blocks()), command.quiet);
        runs.run(command.threads, [&](std::size_t done) { progress.update(std::int64_t(done)); });
        runs.check_numbers(web);
    }
    print_errors(runs.errors());
    if (!runs.errors().empty()) return 2;
    const std::vector<SitePage> pages = make_pages(command, course, runs, templates);
    if (!command.check) write_pages(command, pages);
    return 0;
}

}  // namespace

void add_lesson(Command& command) {
    LessonCommand& c = command.keep<LessonCommand>();
    command.add_option("lesson", c.lessons, "The lessons (Markdown); each becomes a page")
        ->check(file_name("md"))
        ->required()
        ->type_name("LESSON.md");
    CLI::Option* site = command
                            .add_option("-o,--output", c.site,
                                        "The folder of the pages, which need no network: one for each lesson, and\n"
                                        "index.html")
                            ->check(folder_name())
                            ->type_name("SITE");
    command.add_option("--title", c.title, "Title of index.html")->option_text("TEXT [Lessons]");
    command
        .add_option("--language", c.language,
                    "Language of the lessons and of the player: en, de, es or fr; without this the player\n"
                    "has the reader's")
        ->check(some_name())
        ->type_name("CODE");
    command.add_flag("--check", c.check, "Run and check everything, and write nothing")->excludes(site);
    CLI::Option* film =
        command.add_flag("--film", c.films, "A film of each stage for readers without WebGL: larger pages");
    command
        .add_flag_callback(
            "--no-pictures", [&c] { c.pictures = false; },
            "No picture of each stage, for print and for readers without WebGL: quicker")
        ->excludes(film);
    c.threads = machine_threads();
    add_workers(command, c.workers, "Render processes of films; the result is the same for any number");
    add_run(command, c.threads, std::to_string(c.threads), c.quiet);
    command.notes =
        "Lessons need Node.js, and the player and the compiler of lessons, which scripts/build-web builds.\n"
        "A question's answer or a measure that the run does not give is an error; then nothing is written.";
    command.examples =
        "  tumble lesson bouncing.md -o site\n"
        "  tumble lesson lessons/*.md -o site                with links between the lessons\n"
        "  tumble lesson bouncing.md --check --no-pictures   while writing";
    command.logs = true;
    command.run = [&c] { return run_lesson(c); };
}

}  // namespace tumble
