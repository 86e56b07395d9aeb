#include "app/cli/command_line.h"

#include <algorithm>

namespace tumble {

CLI::App* add_lesson(CLI::App& app, CommandLine& line) {
    LessonCommand& c = line.lesson;
    CLI::App* command =
        app.add_subcommand("lesson", "Write web pages from Markdown with scenes, equations and questions");
    command->add_option("lesson", c.lessons, "The lessons (Markdown); each becomes a page")
        ->check(some_name())
        ->required()
        ->type_name("LESSON.md");
    CLI::Option* site = command
                            ->add_option("-o,--output", c.site,
                                         "The folder of the pages, which need no network: one for each lesson, and\n"
                                         "index.html")
                            ->check(some_name())
                            ->type_name("SITE");
    command->add_option("--title", c.title, "Title of index.html")->option_text("TEXT [Lessons]");
    command->add_flag("--check", c.check, "Run and check everything, and write nothing")->excludes(site);
    CLI::Option* film =
        command->add_flag("--film", c.films, "A film of each stage for readers without WebGL: larger pages");
    command
        ->add_flag_callback(
            "--no-pictures", [&c] { c.pictures = false; },
            "No picture of each stage, for print and for readers without WebGL: quicker")
        ->excludes(film);
    c.workers = std::min(machine_threads(), enough_workers);
    c.threads = machine_threads();
    command->add_option("--workers", c.workers, "Render processes of films; the result is the same for any number")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", c.workers));
    add_run(*command, c.threads, std::to_string(c.threads), c.quiet);
    command->footer(
        "Lessons need Node.js, and the player and the compiler of lessons, which scripts/build-web builds.\n"
        "A question's answer or a measure that the run does not give is an error; then nothing is written.\n"
        "Examples:\n"
        "  tumble lesson bouncing.md -o site\n"
        "  tumble lesson lessons/*.md -o site                with links between the lessons\n"
        "  tumble lesson bouncing.md --check --no-pictures   while writing");
    return command;
}

}  // namespace tumble
