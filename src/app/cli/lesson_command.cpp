#include "app/cli/commands.h"
#include "app/cli/page_film.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
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

namespace tumble {
namespace {

namespace fs = std::filesystem;

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

std::vector<SitePage> make_pages(const LessonCommand& command, const Course& course, const LessonRuns& runs,
                                 const PageTemplate& page_template) {
    std::vector<SitePage> pages;
    std::vector<std::string> posters;
    for (std::size_t i = 0; i < course.lessons.size(); ++i) {
        const Lesson& lesson = course.lessons[i];
        std::vector<StagePictures> pictures;
        for (std::size_t s = 0; s < lesson.stages.size(); ++s)
            pictures.push_back(draw_stage(command, lesson.stages[s], runs.scenes()[i].stages[s]));
        if (command.check) continue;
        posters.push_back(pictures.empty() ? std::string() : pictures.front().poster);
        const PageShell shell = lesson_page(course, i, runs.results()[i], pictures, generator);
        pages.push_back({page_name(lesson), page_template.fill(shell)});
    }
    if (!command.check)
        pages.push_back({index_name, page_template.fill(index_page(course, command.title, generator, posters))});
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

}  // namespace

int run_lesson(const LessonCommand& command) {
    if (command.site.empty() && !command.check)
        throw InputError("-o: give the folder of the pages, as in -o site (or --check to write nothing)");
    for (const fs::path& lesson : command.lessons)
        if (!fs::is_regular_file(lesson)) throw InputError(fmt::format("there is no file {}", safe_path(lesson)));
    const fs::path web = find_web_folder();
    const PageTemplate page_template(web);
    const Course course = compile_lessons(command.lessons, web);
    print_errors(course.errors);
    if (!course.errors.empty()) return 2;

    LessonRuns runs(course, generator);
    plan_outputs(command, course, runs, page_template.file());
    if (runs.errors().empty()) {
        Progress progress(std::int64_t(runs.blocks()), command.quiet);
        runs.run(command.threads, [&](std::size_t done) { progress.update(std::int64_t(done)); });
        runs.check_numbers(web);
    }
    print_errors(runs.errors());
    if (!runs.errors().empty()) return 2;
    const std::vector<SitePage> pages = make_pages(command, course, runs, page_template);
    if (!command.check) write_pages(command, pages);
    return 0;
}

}  // namespace tumble
