#include "app/cli/shared_options.h"

#include "compare/platform.h"
#include "core/error.h"
#include "scene/description/overlay.h"
#include "scene/toml/range.h"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace tumble {
namespace {

/// A validator's name is the only thing that an option of CLI11 keeps for others: it is the kind, as in "file csv npz".
/// `mistake`: in the value; empty: there is none.
CLI::Validator kind(const std::string& name, const std::function<std::string(const std::string&)>& mistake) {
    return {[mistake](std::string& text) { return mistake(text); }, "", name};
}

std::string not_empty(const std::string& text) { return text.empty() ? "must not be empty" : ""; }

std::string anything(const std::string&) { return ""; }

}  // namespace

CLI::Validator some_name() { return kind("text", not_empty); }

CLI::Validator file_name(const std::string& endings) { return kind("file " + endings, not_empty); }

CLI::Validator folder_name() { return kind("folder", not_empty); }

CLI::Validator platform_name() {
    return kind("text", [](const std::string& text) {
        return is_platform_name(text) ? "" : "must be the name of a folder, without '/' and no dot at its start";
    });
}

CLI::Validator csv_name() {
    return kind("file csv", [](const std::string& text) {
        const bool npz = std::filesystem::path(text).extension() == ".npz";
        return npz ? "is written as CSV; give it another ending than .npz" : not_empty(text);
    });
}

CLI::Validator number_within(double least, double most) {
    return kind("number", [=](const std::string& text) {
        double value = 0.0;
        const bool within = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
        return within ? "" : fmt::format("Value {} not in range {:g} to {:g}", safe_text(text), least, most);
    });
}

CLI::Validator number() { return kind("number", anything); }

CLI::Validator one_of(const std::string& words) {
    return kind("choice " + manual::replaced(words, "|", " "), anything);
}

CLI::Validator list_of(const std::string& words) { return kind("list " + manual::replaced(words, ",", " "), anything); }

CLI::Option* offer(CLI::Option* option, const std::string& words) {
    return option->check(one_of(words))->option_text(words);
}

manual::ValueKind kind_of(CLI::Option& option) {
    manual::ValueKind kind;
    for (int i = 0;; ++i) {
        std::istringstream words;
        try {
            words.str(option.get_validator(i)->get_name());
        } catch (const CLI::OptionNotFound&) {
            return kind;  // CLI11 does not tell the number of validators
        }
        std::string name;
        words >> name;
        kind.files = kind.files || name == "file";
        kind.folders = kind.folders || name == "folder";
        kind.number = kind.number || name == "number";
        kind.word_list = kind.word_list || name == "list";
        for (std::string word; words >> word;) (name == "file" ? kind.endings : kind.words).push_back(word);
    }
}

void add_scene(CLI::App& command, std::filesystem::path& scene) {
    command.add_option("scene", scene, "The scene file (TOML)")
        ->check(file_name("toml"))
        ->required()
        ->type_name("SCENE");
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
    offer(command.add_option("--method", overrides.method,
                             "tumble: the whole simulation; notes: the course notes to the letter, for teaching"),
          "tumble|notes");
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
        ->check(number())
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
        ->check(number())
        ->type_name("N");
}

void add_frames_of_time(CLI::App& command, SceneOverrides& overrides) {
    add_values(command, overrides);
    add_fps(command, overrides.fps,
            "Frames per second, in place of the scene's (up to 1e6), or a fraction: 24000/1001");
    command
        .add_option("--duration", overrides.duration, "Seconds to simulate, in place of the scene's; 0 is one frame")
        ->check(number())
        ->type_name("S");
}

void add_overlay(CLI::App& command, SceneOverrides& overrides, const std::string& help) {
    std::string names;
    for (const OverlayName& overlay : overlay_names)
        names += fmt::format("{}{}", names.empty() ? "" : ",", overlay.name);
    command.add_option("--overlay", overrides.overlay, help + " " + names)
        ->check(list_of("none," + names))
        ->type_name("LIST");
}

void add_camera(CLI::App& command, SceneOverrides& overrides) {
    command
        .add_option("--camera", overrides.camera,
                    "One of [cameras] for the whole clip, in place of [camera] and [[shot]]. tumble render: all\n"
                    "for frames and AOVs of each, in folders of their names")
        ->type_name("NAME");
}

void add_workers(CLI::App& command, int& workers, const std::string& help, int most) {
    workers = std::min(machine_threads(), most);
    command.add_option("--workers", workers, help)
        ->check(number_within(1, most_threads))
        ->option_text(fmt::format("N [{}]", workers));
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
