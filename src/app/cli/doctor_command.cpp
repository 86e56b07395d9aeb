#include "app/cli/command.h"
#include "app/cli/driver_check.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/process.h"
#include "page/web_folder.h"
#include "plot/canvas.h"
#include "render/gl/shader_source.h"

#include <fmt/format.h>
#include <png.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {
namespace {

struct DoctorCommand {
    double time_limit = 30.0;  // s for each program and driver: a driver without caches takes seconds on a busy machine
};

Finding check_shaders() {
    try {
        return {true, find_shader_folder().string()};
    } catch (const RunError& error) {
        return {false, error.what()};
    }
}

Finding check_ffmpeg(TimeLimit& time_limit) try {
    const auto program = find_program("ffmpeg");
    if (!program) return {false, "not on the PATH"};
    const ProgramOutput version = time_limit.run(*program, {"-hide_banner", "-version"});
    if (version.stopped) return time_limit.late(program->string());
    if (!version.end.ok())
        return {false, fmt::format("{} does not run ({})", program->string(), version.end.describe())};
    const ProgramOutput encoders = time_limit.run(*program, {"-hide_banner", "-encoders"});
    if (encoders.stopped) return time_limit.late(program->string());
    std::string text = version.text.substr(0, version.text.find(" Copyright"));
    for (const char* needed : {"libx264 ", "libvpx-vp9", "gif "})
        if (!encoders.end.ok() || encoders.text.find(needed) == std::string::npos)
            return {false, fmt::format("{} lacks the encoder {}", text, needed)};
    return {true, text};
} catch (const RunError& error) {
    return {false, error.what()};
}

/// Frames with text are the same on two machines only with the same font.
Finding check_font(TimeLimit& time_limit) {
    const auto check = []() -> std::string {
        const std::string family = Canvas(1, 1, 1.0).font_family();
        if (family == "Inter") return family;
        throw RunError(family.empty() ? "no font for text in clips and plots"
                                      : fmt::format("{} in place of Inter", family));
    };
    return in_own_process("the font library", check, time_limit);  // GLib ends its process where memory is short
}

Finding check_player() try { return {true, find_web_folder().string()}; } catch (const RunError&) {
    return {false, "not built"};
}

/// Prints one line of the report, and another one with the remedy if needed.
void print(const char* what, const Finding& finding, const char* remedy) {
    put("  {:<16} {:<8} {}\n", what,
        finding.good               ? "ok"
        : finding.can_be_installed ? "MISSING"
                                   : "FAILS",
        safe_lines(finding.text));
    if (!finding.good && finding.can_be_installed) put("  {:<16} {:<8} try: {}\n", "", "", remedy);
}

std::string versions() {
    return fmt::format("fmt {}.{}.{}, Eigen {}.{}.{}, libpng {}, CLI11 {}", FMT_VERSION / 10000,
                       FMT_VERSION / 100 % 100, FMT_VERSION % 100, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                       EIGEN_MINOR_VERSION, png_get_libpng_ver(nullptr), CLI11_VERSION);
}

int run_doctor(const DoctorCommand& command) {
    TimeLimit time_limit(command.time_limit);
    put("tumble {} ({}, g++ {})\n", TUMBLE_VERSION, TUMBLE_BUILD_TYPE, __VERSION__);
    put("  {:<16} {}\n", "libraries", versions());

    const Finding shaders = check_shaders();
    const Finding osmesa = try_drawing(GlBackend::osmesa, time_limit);
    const Finding egl = try_drawing(GlBackend::egl, time_limit);
    Finding software = osmesa;
    if (osmesa.good) {
        software.text = "OSMesa";
    } else {
        software = try_drawing(GlBackend::software, time_limit);
        if (software.good) software.text = "EGL's software device, because OSMesa does not work here: the same frames";
    }
    const Finding font = check_font(time_limit);
    const Finding ffmpeg = check_ffmpeg(time_limit);
    if (time_limit.interrupted()) throw Interrupted();
    print("shaders", shaders, "set TUMBLE_SHADERS to the folder of that name, or install Tumble again");
    print("OpenGL, osmesa", osmesa, "apt-get install libosmesa6   (not in Debian 14: EGL draws the same frames)");
    print("OpenGL, egl", egl, "apt-get install libegl1 libgl1-mesa-dri   (only for --gl egl, or without OSMesa)");
    print("drawing by", software, "apt-get install libosmesa6, or libegl1 libgl1-mesa-dri");
    print("font", font, "apt-get install fonts-inter   (only for text: other fonts give other pixels)");
    print("player of pages", check_player(),
          "scripts/build-web in Tumble's source tree   (only for page, lesson and render --report)");
    print("ffmpeg", ffmpeg, "apt-get install ffmpeg   (frames can be written without it)");

    const bool able = shaders.good && software.good && ffmpeg.good;
    put("{}\n", able ? "All requirements are met: tumble render works here." : "tumble render does not work here yet.");
    return able ? 0 : 1;
}

}  // namespace

void add_doctor(Command& command) {
    DoctorCommand& c = command.keep<DoctorCommand>();
    command.add_option("--time-limit", c.time_limit, "Seconds that each program and driver may take to answer")
        ->check(number_within(0.001, 1e6))
        ->option_text(fmt::format("S [{:g}]", c.time_limit));
    command.examples = "  tumble doctor";
    command.run = [&c] { return run_doctor(c); };
}

}  // namespace tumble
