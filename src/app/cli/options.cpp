#include "app/cli/options.h"

#include "app/cli/commands.h"
#include "app/cli/say.h"
#include "app/plots/quantities.h"
#include "app/threads/thread_budget.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "scene/toml/limits.h"
#include "sim/frames/clip_timing.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr int enough_workers = 8;  // 65 MiB each; the simulation and the encoder cannot keep more busy

/// "1280x720" to two numbers. Their range is checked with the scene.
template <class Number>
void read_size(const std::string& text, Number& to_width, Number& to_height) {
    int width = 0, height = 0;
    const char* const last = text.data() + text.size();
    const auto [x, bad_width] = std::from_chars(text.data(), last, width);
    bool good = bad_width == std::errc() && x != last && *x == 'x';
    if (good) {
        const auto [end, bad_height] = std::from_chars(x + 1, last, height);
        good = bad_height == std::errc() && end == last;
    }
    if (!good)
        throw InputError(
            fmt::format("--size: must be the width and height in pixels, as in 1280x720 (was '{}')", safe_text(text)));
    to_width = width;
    to_height = height;
}

/// "depth,normal" to a set.
AovSet read_aovs(const std::string& text) {
    AovSet aovs, all;
    for (const Aov aov : all_aovs) all.add(aov);
    for (std::size_t first = 0; first <= text.size();) {
        const std::size_t end = std::min(text.find(',', first), text.size());
        const std::string name = text.substr(first, end - first);
        const std::optional<Aov> aov = aov_named(name);
        if (!aov) throw InputError(fmt::format("--aov: unknown name '{}' (known: {})", safe_text(name), names_of(all)));
        aovs.add(*aov);
        first = end + 1;
    }
    return aovs;
}

/// All options of the command line; each command uses those that it declares.
struct CommandLine {
    RenderCommand render;
    SimulateCommand simulate;
    PlotCommand plot;
    EncodeCommand encode;
    CompareCommand compare;
    InfoCommand info;
    DoctorCommand doctor;
    std::string render_size, plot_size, info_size, aovs;
};

// CLI::Range lets NaN through.
CLI::Validator number_within(double least, double most) {
    return CLI::Validator(
        [=](const std::string& text) {
            double value = 0.0;
            const bool within = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
            return within ? std::string()
                          : fmt::format("Value {} not in range {:g} to {:g}", safe_text(text), least, most);
        },
        "");
}

/// An option with one of a list of names as its value.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& option, T& value,
                        const std::vector<std::pair<std::string, T>>& choices, const std::string& help) {
    return command.add_option_function<std::string>(
        option,
        [=, &value](const std::string& text) {
            std::string names;
            for (const auto& [name, choice] : choices) {
                if (name == text) {
                    value = choice;
                    return;
                }
                names += (names.empty() ? "" : ", ") + name;
            }
            throw CLI::ValidationError(option, fmt::format("must be one of {} (was '{}')", names, safe_text(text)));
        },
        help);
}

// An empty name comes from an unset variable of a script.
CLI::Validator some_name() {
    return CLI::Validator([](const std::string& text) { return text.empty() ? "must not be empty" : ""; }, "");
}

void add_scene(CLI::App& command, std::filesystem::path& scene) {
    command.add_option("scene", scene, "The scene file (TOML)")->check(some_name())->required()->type_name("SCENE");
}

void add_values(CLI::App& command, SceneOverrides& overrides) {
    command
        .add_option("--method", overrides.method,
                    "tumble: the whole simulation; notes: the course notes to the letter, for teaching")
        ->type_name("NAME");
    command
        .add_option("--set", overrides.set,
                    "Any key of the scene by its path, in place of the scene's, as in\nsimulation.sleep=false or "
                    "body.crate.restitution=0.8; may be repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("PATH=VALUE");
    command
        .add_option_function<std::string>(
            "--seed", [&overrides](const std::string& seed) { overrides.set.push_back("simulation.seed=" + seed); },
            "The seed of grids and scatters, in place of the scene's")
        ->type_name("N");
}

void add_frames_of_time(CLI::App& command, SceneOverrides& overrides) {
    add_values(command, overrides);
    command.add_option("--fps", overrides.fps, "Frames per second, in place of the scene's (up to 1e6)")
        ->type_name("N");
    command
        .add_option("--duration", overrides.duration, "Seconds to simulate, in place of the scene's; 0 is one frame")
        ->type_name("S");
}

template <class Threads>
void add_run(CLI::App& command, Threads& threads, const std::string& unless_told, bool& quiet) {
    command.add_option("--threads", threads, "Threads of the simulation; the result is the same for any number")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", unless_told));
    command.add_flag("--quiet", quiet, "Print errors only");
}

void add_quality(CLI::App& command, VideoQuality& quality) {
    add_choice<VideoQuality>(
        command, "--quality", quality,
        {{"draft", VideoQuality::draft}, {"normal", VideoQuality::normal}, {"best", VideoQuality::best}},
        "Quality of the clip. draft: fast to encode, leaves specks behind moving bodies;\n"
        "normal: for viewing; best: looks like the frames (docs/explanation/output.md has\n"
        "time and size). A GIF has one setting")
        ->option_text("draft|normal|best [normal]");
}

CLI::App* add_render(CLI::App& app, CommandLine& line) {
    RenderCommand& c = line.render;
    CLI::App* command =
        app.add_subcommand("render", "Simulate a scene, draw it, and write a clip, PNG frames, or both");
    add_scene(*command, c.scene);
    command
        ->add_option("-o,--output", c.clip,
                     "The clip to write; its ending chooses the format: .mp4 .mov .mkv (H.264),\n"
                     ".webm (VP9), .gif. Without this, --frames and --aov-folder: the scene's\n"
                     "name with .mp4, in this folder")
        ->check(some_name())
        ->type_name("CLIP");
    command->add_option("--frames", c.frames, "Write the frames as DIR/frame_000000.png and so on")
        ->check(some_name())
        ->type_name("DIR");
    command
        ->add_option("--aov", line.aovs,
                     "Write AOVs, exact for every pixel: a list out of depth,normal,segmentation,\nmotion,albedo, as "
                     "DIR/aov_000000.npz and so on, for NumPy's np.load\n(docs/reference/aovs.md)")
        ->type_name("LIST");
    command->add_option("--aov-folder", c.aov_folder, "Folder of the AOVs, in place of that of --frames")
        ->check(some_name())
        ->type_name("DIR");
    command->add_option("--size", line.render_size, "Picture size, in place of the scene's")
        ->check(some_name())
        ->type_name("WxH");
    add_frames_of_time(*command, c.overrides);
    command
        ->add_option("--start", c.start,
                     "Seconds that are simulated and not drawn. Frames keep their numbers and their pixels")
        ->check(number_within(limits::duration.min, limits::duration.max))
        ->option_text("S [0]");
    command
        ->add_option("--samples", c.overrides.samples,
                     "Samples per pixel, in place of the scene's: 1 is fast, 4 smooth")
        ->type_name("N");
    add_choice<GlBackend>(*command, "--gl", c.drawing.backend, {{"osmesa", GlBackend::osmesa}, {"egl", GlBackend::egl}},
                          "OpenGL backend: osmesa (the default) draws on the CPU; egl uses a GPU if there is\none, "
                          "else it draws the same pixels on the CPU")
        ->option_text("osmesa|egl");
    command
        ->add_option("--speed", c.speed,
                     "Speed of the motion: 0.25 is slow motion (the clip lasts four times as long,\n"
                     "at the same frames per second), 2 twice as fast")
        ->check(number_within(slowest_speed, fastest_speed))
        ->option_text("X [1]");
    command->add_option("--shutter", c.shutter, "Motion blur: how long the shutter is open, 180 for half of each frame")
        ->check(number_within(0.0, 360.0))
        ->option_text("DEGREES [0]");
    command->add_option("--blur-samples", c.blur_samples, "Moments averaged while the shutter is open")
        ->check(CLI::Range(2, most_blur_samples))
        ->option_text(fmt::format("N [{}]", c.blur_samples));
    add_quality(*command, c.clip_options.quality);
    command->add_flag_callback(
        "--variable-rate", [&c] { c.clip_options.times = FrameTimes::longer_frames; },
        "Store an unchanged picture once and show it longer, which costs nothing; players show\n"
        "the same, but tools that count stored frames find fewer");
    c.workers = std::min(machine_threads(), enough_workers);
    command->add_option("--workers", c.workers, "Render processes, one per core; the result is the same for any number")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", c.workers));
    add_run(*command, c.threads, "by the bodies", c.quiet);
    command->footer(
        "Examples:\n"
        "  tumble render scene.toml                          writes scene.mp4\n"
        "  tumble render scene.toml -o clip.webm --size 640x360\n"
        "  tumble render scene.toml --frames out             writes out/frame_000000.png ...\n"
        "  tumble render scene.toml --speed 0.25             slow motion\n"
        "  tumble render scene.toml --frames one --duration 0  writes the first frame only\n"
        "  tumble render scene.toml --frames one --start 2.5 --duration 2.5   only the one at 2.5 s\n"
        "  tumble render scene.toml --frames out --aov depth,segmentation   and out/aov_000000.npz ...\n"
        "  tumble render scene.toml --aov motion --aov-folder flow          no pictures at all");
    return command;
}

// "-" is standard output.
CLI::Validator or_standard_output() {
    return {[](std::string& name) {
                if (name == "-") name = "/dev/stdout";
                return std::string();
            },
            ""};
}

/// The mode of impacts, or the file of their table.
void read_impacts(const std::string& text, SimulateCommand& c) {
    const std::filesystem::path file = text == "-" ? "/dev/stdout" : text;
    const bool is_file =
        file.extension() == ".csv" || file.extension() == ".npz" || text.find('/') != std::string::npos;
    if (text == "-" || is_file)
        c.impacts = file;
    else if (text == "stepped" || text == "exact")
        c.overrides.impacts = text;
    else
        throw InputError(fmt::format(
            "--impacts: must be stepped or exact, or a file that ends with .csv or .npz (was '{}')", safe_text(text)));
}

CLI::App* add_simulate(CLI::App& app, CommandLine& line) {
    SimulateCommand& c = line.simulate;
    CLI::App* command = app.add_subcommand("simulate", "Simulate a scene without drawing, and write tables of numbers");
    add_scene(*command, c.scene);
    command
        ->add_option("--trajectory", c.trajectory,
                     "CSV: one row per frame and moving body, with its center of mass, orientation\nand velocities; - "
                     "is standard output")
        ->check(some_name())
        ->transform(or_standard_output())
        ->type_name("T.csv");
    command
        ->add_option("--energy", c.energy,
                     "CSV: one row per frame, with energies, momenta and contacts; - is standard output")
        ->check(some_name())
        ->transform(or_standard_output())
        ->type_name("E.csv");
    CLI::Option* step = command
                            ->add_option("--step", c.overrides.step,
                                         "The fixed step in s, in place of the scene's; it must divide 1/fps")
                            ->type_name("H");
    command->add_option("--steps-per-frame", c.overrides.steps_per_frame, "The same as a number of steps per frame")
        ->excludes(step)
        ->type_name("N");
    command
        ->add_option("--integrator", c.overrides.integrator,
                     "symplectic-euler, explicit-euler, splitting, rk4 or exact")
        ->type_name("NAME");
    command
        ->add_option_function<std::string>(
            "--impacts", [&c](const std::string& text) { read_impacts(text, c); },
            "stepped: resolved at the step; exact: each at its own time. Or a table: a row for each\nimpulse, as CSV "
            "or "
            ".npz; - is standard output. Give it twice for both")
        ->take_all()
        ->allow_extra_args(false)
        ->trigger_on_parse()
        ->type_name("MODE|I.csv");
    command
        ->add_option("--contacts", c.contacts,
                     "CSV or .npz: one row per frame and contact point, with forces and slip; - is standard\noutput")
        ->check(some_name())
        ->transform(or_standard_output())
        ->type_name("C.csv");
    command
        ->add_option("--impact-law", c.overrides.impact_law,
                     "propagating or simultaneous: the rule for several contacts at once")
        ->type_name("NAME");
    add_frames_of_time(*command, c.overrides);
    c.threads = machine_threads();
    add_run(*command, c.threads, std::to_string(c.threads), c.quiet);
    command->footer(
        "Examples:\n"
        "  tumble simulate scene.toml --trajectory t.csv --energy e.csv\n"
        "  tumble simulate scene.toml --energy e.csv --fps 1000 --steps-per-frame 1   every step is a row");
    return command;
}

CLI::App* add_plot(CLI::App& app, CommandLine& line) {
    PlotCommand& c = line.plot;
    CLI::App* command = app.add_subcommand("plot", "Simulate, and plot quantities over time");
    command->add_option("scenes", c.scenes, "Scene files (TOML); several are drawn into one plot")
        ->required()
        ->check(some_name())
        ->type_name("SCENE");
    command->add_option("--of", c.quantities, "Quantities, separated by commas, as in energy,body.ball.y")
        ->required()
        ->check(some_name())
        ->type_name("LIST");
    command->add_option("-o,--output", c.output, "The plot to write: .svg .png or .pdf")
        ->required()
        ->check(some_name())
        ->type_name("FILE");
    command
        ->add_option(
            "--vary", c.vary,
            "A run for each value of a key, as in\nsimulation.integrator=explicit-euler,symplectic-euler; may be "
            "repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("PATH=VALUES");
    command->add_flag("--difference", c.difference, "Plot the difference of each run to the first one");
    command->add_flag("--log", c.log, "Logarithmic vertical axes; of differences the absolute value");
    command->add_option("--title", c.title, "Title, in place of the first scene's")->type_name("TEXT");
    command->add_option("--size", line.plot_size, "Size in pixels (points of a PDF)")
        ->check(some_name())
        ->option_text("WxH [900x540]");
    add_frames_of_time(*command, c.overrides);
    add_run(*command, c.threads, std::to_string(c.threads), c.quiet);
    command->footer(
        quantity_help() +
        "\nExamples:\n"
        "  tumble plot scene.toml --of energy,contacts -o energy.svg\n"
        "  tumble plot scene.toml --of body.ball.y --vary simulation.integrator=explicit-euler,exact -o y.png");
    return command;
}

CLI::App* add_encode(CLI::App& app, CommandLine& line) {
    EncodeCommand& c = line.encode;
    CLI::App* command = app.add_subcommand("encode", "Make a clip from existing frames");
    command->add_option("frames", c.frames, "The folder with frame_000000.png, frame_000001.png and so on")
        ->required()
        ->type_name("DIR");
    command->add_option("-o,--output", c.clip, "The clip to write: .mp4 .mov .mkv .webm or .gif")
        ->required()
        ->type_name("CLIP");
    command->add_option("--fps", c.fps, "Frames per second")->type_name("N")->capture_default_str();
    add_quality(*command, c.quality);
    command->add_flag("--quiet", c.quiet, "Print errors only");
    command->footer("Example:\n  tumble encode out -o clip.mp4 --fps 30");
    return command;
}

CLI::App* add_compare(CLI::App& app, CommandLine& line) {
    CompareCommand& c = line.compare;
    CLI::App* command =
        app.add_subcommand("compare", "Compare two pictures: exit code 0 alike, 1 different, 2 cannot compare");
    command->add_option("a", c.a, "A picture (PNG)")->required()->type_name("A.png");
    command->add_option("b", c.b, "Another, of the same size")->required()->type_name("B.png");
    command
        ->add_option("--diff", c.difference,
                     "Write a picture of the differences: red beyond the tolerance, blue within")
        ->check(some_name())
        ->type_name("D.png");
    command
        ->add_option("--tolerance", c.options.tolerance,
                     "Levels (of 255) that a pixel may differ in each channel without counting")
        ->check(CLI::Range(0, 255))
        ->option_text("N [3]");
    command
        ->add_option("--fraction", c.options.fraction,
                     "Rule pixels: part of the pixels that may differ by more (rounded up to whole\npixels)")
        ->check(number_within(0.0, 1.0))
        ->option_text("F [0.0001]");
    command->add_option("--cluster", c.options.cluster, "Rule cluster: pixels of any 8 x 8 that may differ by more")
        ->check(CLI::Range(0, 64))
        ->option_text("N [4 + 64 F]");
    command
        ->add_option("--window", c.options.window,
                     "Rule window: levels that any 8 x 8 pixels may differ by on average. A single\npixel that is off "
                     "by 64 times that breaks it as well")
        ->check(number_within(0.0, 255.0))
        ->option_text("L [tolerance / 2 + 255 F]");
    command->footer(
        "Pictures are alike if all three rules hold. A rule that fails is named with its value, its limit and its\n"
        "place (x from the left, y from the top, from 0). Pictures of one scene from two processors pass; a\n"
        "small object moved by one pixel (cluster), a lost shadow or a shifted color (window) do not. The 8 x 8 "
        "pixels\n"
        "begin at every fourth row and column. To let single pixels differ by any amount: --window 255.\n"
        "Example:\n  tumble compare golden.png frame_000100.png --diff difference.png");
    return command;
}

CLI::App* add_info(CLI::App& app, CommandLine& line) {
    CLI::App* command = app.add_subcommand("info", "Describe a scene and estimate its cost");
    add_scene(*command, line.info.scene);
    command->add_option("--size", line.info_size, "Picture size, in place of the scene's")
        ->check(some_name())
        ->type_name("WxH");
    add_frames_of_time(*command, line.info.overrides);
    command->footer("Example:\n  tumble info scene.toml");
    return command;
}

void add_doctor(CLI::App& app, CommandLine& line) {
    CLI::App* command =
        app.add_subcommand("doctor", "Check the requirements of rendering, and name a remedy for each that is not met");
    command
        ->add_option("--time-limit", line.doctor.time_limit, "Seconds that each program and driver may take to answer")
        ->check(number_within(0.001, 1e6))
        ->option_text(fmt::format("S [{:g}]", line.doctor.time_limit));
}

}  // namespace

int run_command_line(int argc, char** argv) {
    CommandLine line;
    CLI::App app("Tumble: clips of rigid bodies that fall, bounce and come to rest, drawn without a screen.", "tumble");
    app.set_version_flag("--version", "tumble " TUMBLE_VERSION, "Print the version");
    app.require_subcommand(1);
    app.get_formatter()->column_width(32);
    app.footer(
        "Start here:\n"
        "  tumble doctor                                     is everything there?\n"
        "  tumble info assets/scenes/falling_boxes.toml      bodies, shapes and settings of the scene\n"
        "  tumble render assets/scenes/falling_boxes.toml    makes falling_boxes.mp4\n"
        "\"tumble COMMAND --help\" lists options. Exit codes: 0 done, 1 failed while running (or interrupted), 2 wrong "
        "usage\n"
        "or bad input. Messages and progress go to standard error.");
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return fmt::format("error: {} (see \"tumble --help\" and \"tumble COMMAND --help\")\n",
                           safe_text(error.what(), path_text_bytes));
    });
    const CLI::App* render = add_render(app, line);
    const CLI::App* simulate = add_simulate(app, line);
    const CLI::App* plot = add_plot(app, line);
    const CLI::App* encode = add_encode(app, line);
    const CLI::App* compare = add_compare(app, line);
    const CLI::App* info = add_info(app, line);
    add_doctor(app, line);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostringstream asked_for, wrong;
        const int code = app.exit(error, asked_for, wrong);
        put_text(asked_for.str());
        say_text(wrong.str());
        return code == 0 ? 0 : 2;
    }
    if (!line.render_size.empty())
        read_size(line.render_size, line.render.overrides.width, line.render.overrides.height);
    if (render->get_option("--aov")->count() > 0) line.render.aovs = read_aovs(line.aovs);
    if (!line.info_size.empty()) read_size(line.info_size, line.info.overrides.width, line.info.overrides.height);
    if (!line.plot_size.empty()) read_size(line.plot_size, line.plot.width, line.plot.height);

    if (render->parsed())
        run_render(line.render);
    else if (simulate->parsed())
        run_simulate(line.simulate);
    else if (plot->parsed())
        run_plot(line.plot);
    else if (encode->parsed())
        run_encode(line.encode);
    else if (compare->parsed())
        return run_compare(line.compare);
    else if (info->parsed())
        run_info(line.info);
    else
        return run_doctor(line.doctor);
    return 0;
}

}  // namespace tumble
