#include "app/cli/command_line.h"

#include "core/error.h"

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

std::pair<int, int> read_size(const std::string& text) {
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
    return {width, height};
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
