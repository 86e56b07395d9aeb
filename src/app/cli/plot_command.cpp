#include "app/cli/plot_command.h"

#include "app/causes/motion_record.h"
#include "app/causes/run_recorder.h"
#include "app/cli/command.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/output_plan.h"
#include "app/plots/alike_runs.h"
#include "app/plots/plotted_run.h"
#include "app/plots/variants.h"
#include "app/survey/survey.h"
#include "app/threads/interrupt.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"
#include "plot/figure.h"
#include "presimulation/impact_focus.h"
#include "quantities/quantities.h"
#include "scene/load.h"
#include "scene/toml/limits.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace tumble {
namespace {

constexpr int least_side = 100, most_side = 16384;  // pixels or points

Canvas::Format format_of(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    if (ending == ".svg") return Canvas::Format::svg;
    if (ending == ".pdf") return Canvas::Format::pdf;
    if (ending == ".png") return Canvas::Format::png;
    throw InputError(fmt::format("-o {}: the name must end with .svg, .png or .pdf", safe_path(file)));
}

}  // namespace

void run_plot(const PlotCommand& command) {
    const Canvas::Format format = format_of(command.output);
    if (std::min(command.width, command.height) < least_side || std::max(command.width, command.height) > most_side)
        throw InputError(fmt::format("--size: both sides must be in {} to {} (given {}x{})", least_side, most_side,
                                     command.width, command.height));
    const std::vector<Variant> variants = make_variants(command.scenes, command.overrides, command.vary);
    if (command.difference && variants.size() < 2)
        throw InputError("--difference: needs two runs or more: give several scenes, or --vary (given one run)");
    OutputPlan plan;
    std::vector<SceneDescription> scenes;
    std::vector<PlottedRun> runs;
    for (const Variant& variant : variants) {
        FileList inputs;
        scenes.push_back(focused_on_impacts(load_scene(variant.scene, variant.overrides, &inputs)));
        plan.add_inputs(inputs);
        runs.emplace_back(variant.label, parse_quantities(command.quantities, scenes.back()));
    }
    plan.add("-o", command.output);
    AlikeRuns alike(command.vary);
    std::optional<RunRecorder> recorder;
    if (command.motion_record) recorder.emplace(scenes);
    {
        Interrupt interrupt;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            World world(scenes[i], command.threads);
            std::vector<SurveyObserver*> observers{&runs[i], &alike.add(variants[i].label, scenes[i])};
            if (command.motion_record) {
                world.record_contacts();
                observers.push_back(&recorder->panel(i));
            }
            survey(world, {scenes[i].frame_count(), 1}, observers, interrupt);
        }
    }
    Figure figure;
    figure.title = command.title.value_or(scenes.front().title);
    if (command.difference) figure.subtitle = fmt::format("difference to {}", runs.front().label);
    figure.x_title = "time (s)";
    std::span<PlottedRun> shown = runs;
    if (command.difference) {
        shown = shown.subspan(1);
        for (PlottedRun& run : shown) run.subtract(runs.front());
    }
    figure.panels = make_panels(shown, runs.size() > 1, {command.log, command.difference});

    const double width = command.width, height = command.height;
    figure.text_size = std::clamp(std::min(width / 900.0, height / 540.0) * 15.0, 9.0, 60.0);
    Canvas canvas(format, width, height);
    draw(figure, canvas, {0.0, 0.0, width, height});
    const std::string bytes = canvas.finish();
    if (recorder) write_motion_record(*command.motion_record, recorder->finish());
    write_file(command.output, bytes);
    if (command.quiet) return;
    say_text(alike.warning());
    say("wrote {}\n", safe_path(command.output));
}

void add_plot(Command& command) {
    PlotCommand& c = command.keep<PlotCommand>();
    command.add_option("scenes", c.scenes, "Scene files (TOML); several are drawn into one plot")
        ->required()
        ->check(file_name("toml"))
        ->type_name("SCENE");
    command.add_option("--of", c.quantities, "Quantities, separated by commas, as in energy,body.ball.y")
        ->required()
        ->check(some_name())
        ->type_name("LIST");
    command.add_option("-o,--output", c.output, "The plot to write: .svg .png or .pdf")
        ->required()
        ->check(file_name("svg png pdf"))
        ->type_name("FILE");
    command
        .add_option(
            "--vary", c.vary,
            "A run for each value of a key, as in\nsimulation.integrator=explicit-euler,symplectic-euler; may be "
            "repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("PATH=VALUES");
    command.add_flag("--difference", c.difference, "Plot the difference of each run to the first one");
    command.add_flag("--log", c.log, "Logarithmic vertical axes; of differences the absolute value");
    command.add_option("--title", c.title, "Title, in place of the first scene's")->type_name("TEXT");
    add_size(command, c.width, c.height, "Size in pixels (points of a PDF)")->option_text("WxH [900x540]");
    add_frames_of_time(command, c.overrides);
    add_run(command, c.threads, std::to_string(c.threads), c.quiet);
    command.notes = quantity_help();
    command.examples =
        "  tumble plot scene.toml --of energy,contacts -o energy.svg\n"
        "  tumble plot scene.toml --of body.ball.y --vary simulation.integrator=explicit-euler,exact -o y.png";
    command.run = [&c] {
        run_plot(c);
        return 0;
    };
}

}  // namespace tumble
