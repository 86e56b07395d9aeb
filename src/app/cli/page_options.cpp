#include "app/cli/command_line.h"
#include "scene/toml/limits.h"

#include <algorithm>

namespace tumble {

CLI::App* add_page(CLI::App& app, CommandLine& line) {
    PageCommand& c = line.page;
    CLI::App* command = app.add_subcommand(
        "page", "Simulate, and write a web page with the clip in 3D, its plots, impacts and numbers");
    command->add_option("scene", c.scenes, "The scene files (TOML); several are runs to choose from and compare")
        ->check(some_name())
        ->required()
        ->type_name("SCENE");
    command
        ->add_option("-o,--output", c.output,
                     "The page to write, one file that needs no network; without this the first\n"
                     "scene's name with .html, in this folder")
        ->check(some_name())
        ->type_name("PAGE.html");
    add_vary(*command, c.vary, "A run");
    command
        ->add_option("--label", c.labels,
                     "Name of a run, in place of its varied values; once for each run, in their order")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("TEXT");
    add_choice<std::string>(*command, "--compare", c.compare,
                            {{"single", "single"}, {"ghost", "ghost"}, {"side-by-side", "side-by-side"}},
                            "How the page shows several runs at first: one, the others as ghosts, or all")
        ->option_text("single|ghost|side-by-side");
    add_frames_of_time(*command, c.overrides);
    add_overlay(*command, c.overrides,
                "Overlays that the page shows at first, in place of the scene's: none, or a list\nout of");
    command
        ->add_option("--plot", c.overrides.plot,
                     "Plots that the page shows at first, as in energy,body.ball.y (names: tumble plot\n--help)")
        ->option_text("LIST [energy]");
    command->add_option("--title", c.title, "Title, in place of the scene's")->type_name("TEXT");
    command->add_option("--language", c.language, "Language of the title, for screen readers")
        ->check(some_name())
        ->option_text("CODE [en]");
    command->add_option("--time", c.time, "Moment shown at first")
        ->check(number_within(limits::duration.min, limits::duration.max))
        ->option_text("S [0]");
    command->add_option("--follow", c.follow, "Body that the camera follows at first")->type_name("BODY");
    CLI::Option* no_film = command->add_flag_callback(
        "--no-film", [&c] { c.film = false; }, "No film in the page for readers without WebGL, only a picture");
    command
        ->add_option_function<std::string>(
            "--film-size",
            [&c](const std::string& text) { std::tie(c.film_width, c.film_height) = read_size(text, "--film-size"); },
            "Size of that film; by default its longer side has 640 pixels, 960 for several runs")
        ->excludes(no_film)
        ->check(some_name())
        ->type_name("WxH");
    command->add_flag("--embed-glb", c.embed_glb, "The clip as a glTF file within the page, for download");
    c.threads = machine_threads();
    c.workers = std::min(machine_threads(), enough_workers);
    command->add_option("--workers", c.workers, "Render processes of the film; the result is the same for any number")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", c.workers));
    add_run(*command, c.threads, std::to_string(c.threads), c.quiet);
    command->footer(
        "Pages need the player, which scripts/build-web builds once.\n"
        "Examples:\n"
        "  tumble page scene.toml                            writes scene.html\n"
        "  tumble page scene.toml --vary materials.ball.restitution=0.2,0.5,0.8 --compare ghost\n"
        "  tumble page scene.toml -o ball.html --overlay velocity,forces --plot body.ball.y,energy\n"
        "  tumble page scene.toml --set simulation.impacts=exact   exact between frames too");
    return command;
}

}  // namespace tumble
