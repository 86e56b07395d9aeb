#include "scene/keys/readers.h"

#include "core/frame_rate.h"
#include "scene/description/lamps.h"
#include "scene/fields/settings_fields.h"
#include "scene/keys/read_fields.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace tumble {
namespace {

/// A given value and its source.
template <class Value>
struct Given {
    Value value;
    SourcePosition origin;
};

/// The requested time settings, from the file or the command line.
struct TimeRequest {
    std::optional<Given<double>> duration, fps, step;
    std::optional<Given<std::int64_t>> steps_per_frame;
};

void override_number(const std::optional<double>& given, const char* option, std::optional<Given<double>>& target,
                     const Range& range) {
    if (!given) return;
    const SourcePosition origin{option, {}};
    target = {checked(*given, range, origin), origin};
}

/// Sources of the settings that the method of the notes restricts.
struct MethodSources {
    SourcePosition integrator, impacts, push_out;
};

/// A value that its table has, and its source.
template <class Value>
std::optional<Given<Value>> given_in(const TomlTable& table, std::string_view key, const auto& value) {
    if (const auto found = table.find(key)) return Given<Value>{Value(value), found->origin()};
    return std::nullopt;
}

void read_simulation(const TomlTable& table, SimulationSettings& settings, TimeRequest& time, MethodSources& sources) {
    settings = read_all_fields<SimulationSettings>(table);
    time.duration = given_in<double>(table, "duration", settings.duration);
    time.steps_per_frame = given_in<std::int64_t>(table, "steps_per_frame", settings.steps_per_frame);
    if (const auto value = table.find("step")) time.step = {value->number(limits::step), value->origin()};
    if (time.step && time.steps_per_frame)
        table.find("steps_per_frame")->fail("and step exclude each other: give one of them");
    if (const auto value = table.find("integrator")) sources.integrator = value->origin();
    if (const auto value = table.find("impacts")) sources.impacts = value->origin();
    if (const auto value = table.find("push_out")) sources.push_out = value->origin();
}

void check_samples(std::int64_t samples, const SourcePosition& origin) {
    if (samples != 1 && samples != 2 && samples != 4) origin.fail(fmt::format("must be 1, 2 or 4 (given {})", samples));
}

void read_output(const TomlTable& table, OutputSettings& output, TimeRequest& time) {
    table.expect_keys(list_keys<OutputSettings>().keys);
    if (const auto value = table.find("size")) {
        const auto side = value->items(2, "whole numbers, width and height");
        output.width = static_cast<int>(side[0].integer(1, limits::image_side));
        output.height = static_cast<int>(side[1].integer(1, limits::image_side));
    }
    if (const auto value = table.find("fps")) time.fps = {value->frame_rate(), value->origin()};
    if (const auto value = table.find("samples")) {
        const std::int64_t samples =
            value->integer(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
        check_samples(samples, value->origin());
        output.samples = static_cast<int>(samples);
    }
    read_fields(table, output);
}

bool is_euler(IntegratorKind kind) {
    return kind == IntegratorKind::symplectic_euler || kind == IntegratorKind::explicit_euler;
}

void check_method(const SimulationSettings& settings, const SceneOverrides& overrides, MethodSources sources) {
    if (settings.method != SimulationMethod::notes) {
        if (settings.push_out)
            sources.push_out.fail("has an effect with method = \"notes\" only: give both, or neither");
        return;
    }
    if (overrides.integrator) sources.integrator = {"--integrator", {}};
    if (overrides.impacts) sources.impacts = {"--impacts", {}};
    if (!is_euler(settings.integrator))
        sources.integrator.fail("must be \"symplectic-euler\" or \"explicit-euler\" with the method of the notes");
    if (settings.impacts == ImpactMode::exact)
        sources.impacts.fail("must be \"stepped\" with the method of the notes (given \"exact\")");
}

void apply_overrides(const SceneOverrides& overrides, SimulationSettings& simulation, OutputSettings& output,
                     TimeRequest& time) {
    override_number(overrides.duration, "--duration", time.duration, limits::duration);
    override_number(overrides.fps, "--fps", time.fps, limits::fps);
    if (overrides.step && overrides.steps_per_frame) {
        SourcePosition{"--step", {}}.fail("cannot be given together with --steps-per-frame: give one of them");
    }
    // Either option defines the step completely, so the file's settings of the step are dropped.
    if (overrides.step || overrides.steps_per_frame) time.step.reset(), time.steps_per_frame.reset();
    override_number(overrides.step, "--step", time.step, limits::step);
    if (overrides.steps_per_frame) {
        const SourcePosition origin{"--steps-per-frame", {}};
        time.steps_per_frame = {checked(*overrides.steps_per_frame, 1, limits::steps_per_frame, origin), origin};
    }
    if (overrides.integrator) {
        simulation.integrator =
            chosen<IntegratorKind>(*overrides.integrator, choices<IntegratorKind>, {"--integrator", {}});
    }
    if (overrides.method)
        simulation.method = chosen<SimulationMethod>(*overrides.method, choices<SimulationMethod>, {"--method", {}});
    if (overrides.impacts)
        simulation.impacts = chosen<ImpactMode>(*overrides.impacts, choices<ImpactMode>, {"--impacts", {}});
    if (overrides.impact_law) {
        simulation.impact_law = chosen<ImpactLaw>(*overrides.impact_law, choices<ImpactLaw>, {"--impact-law", {}});
    }
    if (overrides.width) {
        output.width = static_cast<int>(checked(*overrides.width, 1, limits::image_side, {"--size", {}}));
    }
    if (overrides.height) {
        output.height = static_cast<int>(checked(*overrides.height, 1, limits::image_side, {"--size", {}}));
    }
    if (overrides.samples) {
        check_samples(*overrides.samples, {"--samples", {}});
        output.samples = *overrides.samples;
    }
}

/// The integer number of steps in a frame of 1/fps seconds, within the tolerance of the scene format.
int steps_in_a_frame(const TimeRequest& time, double fps) {
    const double step = time.step->value;
    // If --fps replaced the file's rate, the error names the option.
    const SourcePosition& origin = time.fps && time.fps->origin.is_option() ? time.fps->origin : time.step->origin;
    const double frame = 1.0 / fps;
    const double ratio = frame / step;
    const double steps = std::max(1.0, std::nearbyint(ratio));
    if (steps > static_cast<double>(limits::steps_per_frame)) {
        origin.fail(fmt::format("makes more than {} steps a frame (a step of {} s in a frame of 1/{} s)",
                                limits::steps_per_frame, number_text(step), fps_text(fps)));
    }
    if (std::fabs(steps * step - frame) > limits::step_tolerance) {
        const double more = std::max(1.0, std::ceil(ratio)), fewer = std::max(1.0, std::floor(ratio));
        const double shorter = 1.0 / (fps * more), longer = 1.0 / (fps * fewer);
        const double nearest = std::fabs(shorter - step) <= std::fabs(longer - step) ? shorter : longer;
        origin.fail(
            fmt::format("does not fit: a step must divide the frame's 1/{} s; the nearest that does is {} s "
                        "(given a step of {} s)",
                        fps_text(fps), number_text(nearest), number_text(step)));
    }
    return static_cast<int>(steps);
}

void check_frame_count(const TimeRequest& time, double duration, double fps) {
    const double frames = std::floor(duration * fps) + 1.0;
    if (frames <= static_cast<double>(limits::frames)) return;
    // The defaults alone satisfy the limit, so one of the two was given; the error names an option rather than the
    // file.
    const bool blame_fps =
        !time.duration || (time.fps && time.fps->origin.is_option() && !time.duration->origin.is_option());
    (blame_fps ? time.fps : time.duration)
        ->origin.fail(
            fmt::format("makes too many frames: {} s at {} frames a second are {:.4g}, and the limit is {} (given {})",
                        number_text(duration), fps_text(fps), frames, limits::frames,
                        blame_fps ? fps_text(fps) : number_text(duration)));
}

constexpr std::size_t most_shadows = 2;  // lights

LampDescription read_lamp(const TomlTable& table) {
    LampDescription lamp = read_all_fields<LampDescription>(table);
    const bool sun = lamp.type == LightType::sun, spot = lamp.type == LightType::spot;
    const auto refuse = [&](const char* key, const char* instead) {
        if (const auto value = table.find(key))
            value->origin().fail(fmt::format("has no effect on a {} light: {}", name_of(lamp.type), instead));
    };
    if (sun) refuse("position", "give its direction alone, or type = \"point\"");
    if (!spot) refuse("angle", "drop it, or give type = \"spot\"");
    if (!sun && !spot) refuse("direction", "drop it, or give type = \"spot\"");
    if (!sun) table.require("position");
    if (!sun && !spot && lamp.shadows)
        table.find("shadows")->fail(
            "is for suns and spots: the shadows of a point light would take six maps, 36 ms of a frame of 1280 x 720; "
            "drop the key, or give type = \"spot\"");
    lamp.direction.normalize();
    return lamp;
}

}  // namespace

void read_run_settings(const TomlTable& root, const SceneOverrides& overrides, SimulationSettings& simulation,
                       OutputSettings& output) {
    TimeRequest time;
    MethodSources sources;
    if (const auto table = root.find_table("simulation")) read_simulation(*table, simulation, time, sources);
    if (const auto table = root.find_table("output")) read_output(*table, output, time);
    apply_overrides(overrides, simulation, output, time);
    check_method(simulation, overrides, sources);

    if (time.duration) simulation.duration = time.duration->value;
    if (time.fps) output.fps = time.fps->value;
    if (time.steps_per_frame) simulation.steps_per_frame = static_cast<int>(time.steps_per_frame->value);
    if (time.step) simulation.steps_per_frame = steps_in_a_frame(time, output.fps);
    check_frame_count(time, simulation.duration, output.fps);
}

void read_lights(const TomlTable& root, SceneDescription& scene) {
    const auto given = root.find("light");
    if (!given) return;
    if (!given->is_array()) {
        scene.light = read_all_fields<LightDescription>(*root.find_table("light"));
        return;
    }
    std::optional<std::size_t> first_sun;
    std::size_t with_shadows = 0;
    for (TomlTable& table : given->tables("; write [[light]] for each")) {
        table.set_title("[[light]]");
        scene.lamps.push_back(read_lamp(table));
        const std::size_t at = scene.lamps.size() - 1;
        if (std::int64_t(at) == limits::lamps)
            table.origin().fail(fmt::format("is one too many: a scene has {} lights at most", limits::lamps));
        if (scene.lamps[at].type == LightType::sun && !first_sun && !table.has("shadows")) first_sun = at;
        if (scene.lamps[at].shadows && ++with_shadows > most_shadows)
            table.find("shadows")->fail(
                "is on for two lights already: each shadow map costs 6 ms of a frame of 1280 x 720, and there are two; "
                "give shadows = false here or there");
    }
    if (with_shadows == 0 && first_sun) scene.lamps[*first_sun].shadows = true;
    const auto sun = main_sun(scene.lamps);
    if (sun) scene.light.direction = scene.lamps[*sun].direction;
    scene.light.shadows = sun && scene.lamps[*sun].shadows;
}

PairRules read_contact(const TomlTable& root) {
    const auto table = root.find_table("contact");
    return table ? read_all_fields<PairRules>(*table) : PairRules{};
}

std::optional<WindDescription> read_wind(const TomlTable& root) {
    const auto table = root.find_table("wind");
    if (!table) return std::nullopt;
    return read_all_fields<WindDescription>(*table);
}

}  // namespace tumble
