#include "app/cli/commands.h"
#include "app/cli/say.h"
#include "app/threads/interrupt.h"
#include "app/threads/stage_timer.h"
#include "core/error.h"
#include "core/image.h"
#include "core/memory_limit.h"
#include "core/safe_text.h"
#include "output/process.h"
#include "render/gl/shader_locator.h"

#include <fmt/format.h>
#include <png.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <vector>

namespace tumble {
namespace {

struct Finding {
    bool good = false;
    std::string text;
    bool can_be_installed = true;  // true if an installation is the remedy
};

/// Waits for child processes until they end, the time limit is reached, or Ctrl-C is pressed.
class TimeLimit {
public:
    explicit TimeLimit(double limit) : limit_(limit) {}

    ProgramOutput run(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
        return run_program(program, arguments, stop());
    }
    ProgramOutput listen(pid_t id, int pipe) { return listen_to(id, pipe, stop()); }

    bool interrupted() const { return interrupted_; }

    /// The finding for a child that was stopped.
    Finding late(const std::string& what) const {
        return {false, fmt::format("{} does not answer (ended after {:g} s)", what, limit_), false};
    }

private:
    std::function<bool()> stop() {
        return [this, end = wall_seconds() + limit_] {
            interrupted_ = interrupted_ || interrupt_.pending();
            return interrupted_ || wall_seconds() >= end;
        };
    }

    double limit_;  // s
    Interrupt interrupt_;
    bool interrupted_ = false;
};

constexpr int failed = 1, out_of_memory = 3;  // exit codes of a check

/// Runs a check in the child process.
[[noreturn]] void run_check(const std::function<std::string()>& check, int pipe) {
    ::setpgid(0, 0);  // Ctrl-C must reach it only through the parent
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    std::string text;
    int code = 0;
    try {
        text = check();
    } catch (const MemoryError& error) {
        text = error.what();
        code = out_of_memory;
    } catch (const std::bad_alloc&) {
        text = "out of memory" + memory_limit_note();
        code = out_of_memory;
    } catch (const std::exception& error) {
        text = error.what();
        code = failed;
    }
    if (::write(pipe, text.data(), text.size()) < 0) code = failed;
    ::_exit(code);  // no destructors of the parent's objects, no second flush of its streams
}

/// Runs `check` in a process of its own: a driver that crashes or hangs is a finding as well.
Finding in_own_process(const std::function<std::string()>& check, TimeLimit& time_limit) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return {false, "cannot make a pipe"};
    std::fflush(nullptr);
    const pid_t id = ::fork();
    if (id == 0) {
        ::close(ends[0]);
        run_check(check, ends[1]);
    }
    ::close(ends[1]);
    ProgramOutput output;
    if (id > 0) output = time_limit.listen(id, ends[0]);
    ::close(ends[0]);
    if (id < 0) return {false, "cannot start a process"};
    if (output.stopped) return time_limit.late("the driver");
    if (output.end.signal == 0) return {output.end.ok(), output.text, output.end.exit_code != out_of_memory};
    const std::string limit = memory_limit_note();
    return {false, fmt::format("the driver crashed ({}){}", strsignal(output.end.signal), limit), limit.empty()};
}

/// Draws an empty scene of a few pixels.
Finding try_drawing(GlBackend backend, TimeLimit& time_limit) {
    const auto check = [backend] {
        SceneDescription scene;
        scene.output.width = scene.output.height = 32;
        scene.camera.eye = {0.0, 1.0, 5.0};
        scene.camera.target = {0.0, 0.0, 0.0};
        RenderOptions options;
        options.backend = backend;
        Renderer renderer(scene, options);
        const Image& image = renderer.render(Snapshot());
        if (image.width != 32 || image.height != 32) throw RunError("the picture has a different size than requested");
        return renderer.driver();
    };
    return in_own_process(check, time_limit);
}

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

}  // namespace

int run_doctor(const DoctorCommand& command) {
    TimeLimit time_limit(command.time_limit);
    put("tumble {} ({}, g++ {})\n", TUMBLE_VERSION, TUMBLE_BUILD_TYPE, __VERSION__);
    put("  {:<16} {}\n", "libraries", versions());

    const Finding shaders = check_shaders();
    const Finding osmesa = try_drawing(GlBackend::osmesa, time_limit);
    const Finding egl = try_drawing(GlBackend::egl, time_limit);
    const Finding ffmpeg = check_ffmpeg(time_limit);
    if (time_limit.interrupted()) throw RunError("interrupted");
    print("shaders", shaders, "set TUMBLE_SHADERS to the folder of that name, or install Tumble again");
    print("OpenGL, osmesa", osmesa, "apt-get install libosmesa6");
    print("OpenGL, egl", egl, "apt-get install libegl1 libgl1-mesa-dri   (only for --gl egl)");
    print("ffmpeg", ffmpeg, "apt-get install ffmpeg   (frames can be written without it)");

    const bool able = shaders.good && osmesa.good && ffmpeg.good;
    put("{}\n", able ? "All requirements are met: tumble render works here." : "tumble render does not work here yet.");
    return able ? 0 : 1;
}

}  // namespace tumble
