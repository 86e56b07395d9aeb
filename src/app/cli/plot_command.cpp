#include "app/cli/commands.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/plots/quantities.h"
#include "app/plots/variants.h"
#include "app/threads/interrupt.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"
#include "plot/figure.h"
#include "scene/load.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>

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

/// A variant's scene and the values of its quantities at each frame.
struct PlottedRun {
    std::string label;
    SceneDescription scene;
    std::vector<Quantity> quantities;
    std::vector<double> times;                // s
    std::vector<std::vector<double>> values;  // by quantity
};

void simulate(PlottedRun& run, int threads, Interrupt& interrupt) {
    const bool measures = std::any_of(run.quantities.begin(), run.quantities.end(),
                                      [](const Quantity& q) { return q.needs_measurement; });
    run.values.resize(run.quantities.size());
    World world(run.scene, threads);
    const std::int64_t frames = run.scene.frame_count();
    for (std::int64_t n = 0; n < frames; ++n) {
        if (n > 0) world.advance_frame();
        const Snapshot snapshot = world.snapshot();
        const Measurement measurement = measures ? world.measure() : Measurement{};
        run.times.push_back(snapshot.time);
        for (std::size_t k = 0; k < run.quantities.size(); ++k)
            run.values[k].push_back(run.quantities[k].value({snapshot, measurement}));
        if (interrupt.pending()) throw RunError("interrupted");
    }
}

/// Every run's values minus those of the first run at the same time; nothing where it has none.
void subtract_first(std::vector<PlottedRun>& runs) {
    const PlottedRun first = runs.front();
    for (PlottedRun& run : runs)
        for (std::size_t k = 0; k < run.values.size(); ++k)
            for (std::size_t i = 0; i < run.times.size(); ++i) {
                const auto at = std::lower_bound(first.times.begin(), first.times.end(), run.times[i] - 1e-9);
                const bool has = at != first.times.end() && *at <= run.times[i] + 1e-9;
                run.values[k][i] -= has ? first.values[k][std::size_t(at - first.times.begin())]
                                        : std::numeric_limits<double>::quiet_NaN();
            }
    runs.erase(runs.begin());
}

std::string line_label(const PlottedRun& run, const Quantity& quantity, bool several_runs, bool several_quantities) {
    if (!several_runs) return quantity.label;
    return several_quantities ? fmt::format("{}, {}", quantity.label, run.label) : run.label;
}

std::vector<Panel> make_panels(const std::vector<PlottedRun>& runs, const PlotCommand& command, bool several_runs) {
    std::vector<Panel> panels;
    const auto& quantities = runs.front().quantities;
    for (std::size_t k = 0; k < quantities.size(); ++k) {
        const std::string title = (command.difference ? "difference of " : "") + quantities[k].panel;
        auto panel = std::find_if(panels.begin(), panels.end(), [&](const Panel& p) { return p.title == title; });
        if (panel == panels.end()) {
            panels.push_back({title, command.log, {}});
            panel = panels.end() - 1;
        }
        const auto same = std::count_if(quantities.begin(), quantities.end(),
                                        [&](const Quantity& q) { return q.panel == quantities[k].panel; });
        for (const PlottedRun& run : runs) {
            Series series{line_label(run, run.quantities[k], several_runs, same > 1), run.times, run.values[k],
                          panel->series.size(), false};
            if (command.difference && command.log)
                for (double& y : series.y) y = std::fabs(y);
            panel->series.push_back(std::move(series));
        }
    }
    // With a single quantity the panel names its body.
    if (quantities.size() == 1 && !several_runs && quantities[0].label != quantities[0].panel &&
        !quantities[0].needs_measurement)
        panels[0].title = fmt::format("{} of {}", panels[0].title, quantities[0].label);
    return panels;
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
    std::vector<PlottedRun> runs;
    for (const Variant& variant : variants) {
        FileList inputs;
        PlottedRun run{variant.label, load_scene(variant.scene, variant.overrides, &inputs), {}, {}, {}};
        for (const auto& file : inputs) plan.add_input(file);
        run.quantities = parse_quantities(command.quantities, run.scene);
        runs.push_back(std::move(run));
    }
    plan.add("-o", command.output);
    {
        Interrupt interrupt;
        for (PlottedRun& run : runs) simulate(run, command.threads, interrupt);
    }
    const bool several_runs = runs.size() > 1;
    Figure figure;
    figure.title = command.title.value_or(runs.front().scene.title);
    if (command.difference) figure.subtitle = fmt::format("difference to {}", runs.front().label);
    figure.x_title = "time (s)";
    if (command.difference) subtract_first(runs);
    figure.panels = make_panels(runs, command, several_runs);

    const double width = command.width, height = command.height;
    figure.text_size = std::clamp(std::min(width / 900.0, height / 540.0) * 15.0, 9.0, 60.0);
    Canvas canvas(format, width, height);
    draw(figure, canvas, {0.0, 0.0, width, height});
    const std::string bytes = canvas.finish();
    write_file(command.output, std::as_bytes(std::span(bytes)));
    if (!command.quiet) say("wrote {}\n", safe_path(command.output));
}

}  // namespace tumble
