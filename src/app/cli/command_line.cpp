#include "app/cli/command_line.h"

#include "compare/platform.h"
#include "core/error.h"
#include "scene/description/overlay.h"
#include "scene/toml/frame_rate_text.h"

#include <charconv>
#include <filesystem>

namespace tumble {
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

CLI::Validator some_name() {
    return CLI::Validator([](const std::string& text) { return text.empty() ? "must not be empty" : ""; }, "");
}

CLI::Validator platform_name() {
    return CLI::Validator(
        [](const std::string& text) {
            return is_platform_name(text) ? "" : "must be the name of a folder, without '/' and no dot at its start";
        },
        "");
}

CLI::Validator csv_name() {
    return CLI::Validator(
        [](const std::string& text) {
            if (text.empty()) return "must not be empty";
            return std::filesystem::path(text).extension() == ".npz"
                       ? "is written as CSV; give it another ending than .npz"
                       : "";
        },
        "");
}

void add_scene(CLI::App& command, std::filesystem::path& scene) {
    command.add_option("scene", scene, "The scene file (TOML)")->check(some_name())->required()->type_name("SCENE");
}

std::pair<int, int> read_size(const std::string& text, const char* option) {
    int width = 0, height = 0;
    const char* const last = text.data() + text.size();
    const auto [x, bad_width] = std::from_chars(text.data(), last, width);
    bool good = bad_width == std::errc() && x != last && *x == 'x';
    if (good) {
        const auto [end, bad_height] = std::from_chars(x + 1, last, height);
        good = bad_height == std::errc() && end == last;
    }
    if (!good)
        throw InputError(fmt::format("{}: must be the width and height in pixels, as in 1280x720 (was '{}')", option,
                                     safe_text(text)));
    return {width, height};
}

void add_values(CLI::App& command, SceneOverrides& overrides) {
    command
        .add_option("--method", overrides.method,
                    "tumble: the whole simulation; notes: the course notes to the letter, for teaching")
        ->option_text("tumble|notes");
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

void add_fps(CLI::App& command, std::optional<double>& fps, const std::string& help) {
    command
        .add_option_function<std::string>(
            "--fps",
            [&fps](const std::string& text) {
                fps = read_frame_rate(text, {"--fps", {}});
            },
            help)
        ->type_name("N");
}

void add_frames_of_time(CLI::App& command, SceneOverrides& overrides) {
    add_values(command, overrides);
    add_fps(command, overrides.fps,
            "Frames per second, in place of the scene's (up to 1e6), or a fraction: 24000/1001");
    command
        .add_option("--duration", overrides.duration, "Seconds to simulate, in place of the scene's; 0 is one frame")
        ->type_name("S");
}

void add_overlay(CLI::App& command, SceneOverrides& overrides, const std::string& help) {
    std::string names;
    for (const OverlayName& overlay : overlay_names)
        names += fmt::format("{}{}", names.empty() ? "" : ",", overlay.name);
    command.add_option("--overlay", overrides.overlay, help + " " + names)->type_name("LIST");
}

void add_vary(CLI::App& command, std::vector<std::string>& vary, const std::string& what) {
    command
        .add_option("--vary", vary,
                    what +
                        " for each value of a key, side by side, as in\n"
                        "simulation.integrator=explicit-euler,symplectic-euler; may be repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("PATH=V,V");
}

CLI::Validator or_standard_output() {
    return {[](std::string& name) {
                if (name == "-") name = "/dev/stdout";
                return std::string();
            },
            ""};
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

}  // namespace tumble
