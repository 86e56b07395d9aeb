#include "app/lesson/convergence.h"

#include "app/lesson/lesson_scene.h"
#include "app/plots/plotted_run.h"
#include "app/survey/survey.h"
#include "quantities/quantities.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tumble {
namespace {

constexpr double slope_tolerance = 0.1;
/// Errors below this part of the exact value (or of 1) are rounding.
constexpr double rounding = 1e-12;

/// "body.ball.position" is the place of the body; its error is a distance.
std::string quantity_list(const std::string& of) {
    constexpr std::string_view ending = ".position";
    if (!of.ends_with(ending)) return of;
    const std::string body = of.substr(0, of.size() - ending.size());
    return fmt::format("{0}.x,{0}.y,{0}.z", body);
}

std::vector<Quantity> quantities(const LessonConvergence& block, const SceneDescription& scene) {
    std::vector<Quantity> found;
    with_place(block.places.of("of"), "of", [&] { found = parse_quantities(quantity_list(block.of), scene); });
    return found;
}

/// The quantity's components at the time of the block.
std::vector<double> value_at(const LessonConvergence& block, const SceneDescription& scene, Interrupt& interrupt) {
    PlottedRun run("", quantities(block, scene));
    World world(scene, 1);
    SurveyObserver* const observers[] = {&run};
    survey(world, {std::int64_t(std::llround(block.at * scene.output.fps)) + 1, 1}, observers, interrupt);
    std::vector<double> value;
    for (const auto& values : run.values) value.push_back(values.back());
    return value;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

/// Least squares of log(error) over log(step), of the errors above the floor.
std::optional<double> fitted_slope(const ConvergenceLine& line, double floor) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < line.steps.size(); ++i) {
        if (line.errors[i] <= floor) continue;
        const double log_step = std::log(line.steps[i]), log_error = std::log(line.errors[i]);
        n += 1.0;
        x += log_step;
        y += log_error;
        xx += log_step * log_step;
        xy += log_step * log_error;
    }
    if (n < 3.0 || 2.0 * n <= double(line.steps.size())) return std::nullopt;
    return (n * xy - x * y) / (n * xx - x * x);
}

void check_slope(const LessonConvergence& block, const ConvergenceLine& line) {
    const auto stated = block.slopes.find(line.integrator);
    if (stated == block.slopes.end()) return;
    const std::string measured =
        line.slope ? fmt::format("{:.3f}", *line.slope) : std::string("none: the errors are rounding");
    if (!line.slope || std::abs(*line.slope - stated->second) > slope_tolerance)
        throw InputError(
            block.places.of("slopes"),
            fmt::format("slopes: {} has slope {:g} in the lesson, and {} in the runs (allowed deviation {:g})",
                        line.integrator, stated->second, measured, slope_tolerance));
}

}  // namespace

ConvergenceRuns load_convergence(const LessonConvergence& block, FileList& read) {
    const auto load = [&](const std::string& integrator, int steps) {
        SceneOverrides overrides;
        overrides.set = block.scene.set;
        overrides.integrator = integrator == "runge-kutta-4" ? "rk4" : integrator;
        overrides.steps_per_frame = steps;
        SceneDescription scene = load_lesson_scene(block.scene, overrides, block.places, read);
        const double frame = block.at * scene.output.fps;
        if (std::abs(frame - std::round(frame)) > 1e-6 || block.at > scene.simulation.duration + 1e-9)
            throw InputError(
                block.places.of("at"),
                fmt::format("at: must be the time of a frame, at most {:g} s (given {:g}, {:g} frames a second)",
                            scene.simulation.duration, block.at, scene.output.fps));
        const std::size_t components = quantities(block, scene).size();
        if (components != 1 && !block.of.ends_with(".position"))
            throw InputError(block.places.of("of"), fmt::format("of: must be one quantity (given {})", block.of));
        return scene;
    };
    ConvergenceRuns runs;
    for (const std::string& integrator : block.integrators) {
        std::vector<SceneDescription>& scenes = runs.scenes.emplace_back();
        for (const int steps : block.steps_per_frame) scenes.push_back(load(integrator, steps));
    }
    if (!block.reference.empty())
        runs.reference = load(block.reference, *std::ranges::max_element(block.steps_per_frame));
    return runs;
}

std::vector<ConvergenceLine> run_convergence(const LessonConvergence& block, const ConvergenceRuns& runs,
                                             Interrupt& interrupt) {
    const std::vector<double> exact =
        runs.reference ? value_at(block, *runs.reference, interrupt) : std::vector<double>{block.exact.value_or(0.0)};
    double size = 0.0;
    for (const double component : exact) size = std::max(size, std::abs(component));
    const double floor = rounding * std::max(1.0, size);
    std::vector<ConvergenceLine> lines;
    for (std::size_t i = 0; i < runs.scenes.size(); ++i) {
        ConvergenceLine& line = lines.emplace_back();
        line.integrator = block.integrators[i];
        std::vector<std::pair<double, double>> points;
        for (const SceneDescription& scene : runs.scenes[i])
            points.emplace_back(1.0 / (scene.output.fps * scene.simulation.steps_per_frame),
                                distance(value_at(block, scene, interrupt), exact));
        std::ranges::sort(points);
        for (const auto& [step, error] : points) {
            line.steps.push_back(step);
            line.errors.push_back(error);
        }
        line.slope = fitted_slope(line, floor);
        check_slope(block, line);
    }
    return lines;
}

}  // namespace tumble
