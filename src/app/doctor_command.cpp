#include "app/commands.h"
#include "core/error.h"
#include "core/image.h"
#include "core/safe_text.h"
#include "output/process.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <png.h>

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>

namespace tumble {
namespace {

struct Finding {
    bool good = false;
    std::string text;
};

/// Runs `look` in a process of its own: a broken driver that crashes is a finding too.
Finding in_own_process(const std::function<std::string()>& look) {
    int ends[2];
    if (::pipe(ends) != 0) return {false, "cannot make a pipe"};
    std::fflush(nullptr);
    const pid_t id = ::fork();
    if (id < 0) return {false, "cannot start a process"};
    if (id == 0) {
        ::close(ends[0]);
        std::string text;
        int code = 0;
        try {
            text = look();
        } catch (const std::exception& error) {
            text = error.what();
            code = 1;
        }
        if (::write(ends[1], text.data(), text.size()) < 0) code = 1;
        ::_exit(code);   // no destructors of the parent's objects, no second flush of its streams
    }
    ::close(ends[1]);
    Finding finding;
    std::array<char, 4096> part;
    for (ssize_t n; (n = ::read(ends[0], part.data(), part.size())) != 0;) {
        if (n < 0 && errno != EINTR) break;
        if (n > 0) finding.text.append(part.data(), static_cast<std::size_t>(n));
    }
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(id, &status, 0) < 0 && errno == EINTR) {}
    finding.good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (WIFSIGNALED(status)) finding.text = fmt::format("the driver crashed ({})", strsignal(WTERMSIG(status)));
    return finding;
}

/// Draws an empty scene of a few pixels.
Finding try_drawing(GlBackend backend) {
    return in_own_process([backend] {
        SceneDescription scene;
        scene.output.width = scene.output.height = 32;
        scene.camera.eye = {0.0, 1.0, 5.0};
        scene.camera.target = {0.0, 0.0, 0.0};
        RenderOptions options;
        options.backend = backend;
        Renderer renderer(scene, options);
        Snapshot snapshot;
        Image image;
        renderer.render(snapshot, image);
        if (image.width != 32 || image.height != 32) throw RunError("the picture has another size than asked for");
        return renderer.driver();
    });
}

Finding look_for_shaders() {
    try {
        return {true, find_shader_folder().string()};
    } catch (const RunError& error) {
        return {false, error.what()};
    }
}

Finding look_for_ffmpeg() {
    const auto program = find_program("ffmpeg");
    if (!program) return {false, "not on the PATH"};
    const auto version = output_of(*program, {"-hide_banner", "-version"});
    if (!version) return {false, fmt::format("{} does not run", program->string())};
    const auto encoders = output_of(*program, {"-hide_banner", "-encoders"});
    std::string text = version->substr(0, version->find(" Copyright"));
    for (const char* needed : {"libx264 ", "libvpx-vp9", "gif "})
        if (!encoders || encoders->find(needed) == std::string::npos)
            return {false, fmt::format("{} lacks the encoder {}", text, needed)};
    return {true, text};
}

/// One line of the report, and one more with the remedy where it is needed.
void print(const char* what, const Finding& finding, const char* remedy) {
    fmt::print("  {:<16} {:<8} {}\n", what, finding.good ? "ok" : "MISSING", safe_lines(finding.text));
    if (!finding.good) fmt::print("  {:<16} {:<8} try: {}\n", "", "", remedy);
}

std::string versions() {
    return fmt::format("fmt {}.{}.{}, Eigen {}.{}.{}, libpng {}, CLI11 {}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                       FMT_VERSION % 100, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION,
                       png_get_libpng_ver(nullptr), CLI11_VERSION);
}

}  // namespace

int run_doctor() {
    fmt::print("tumble {} ({}, g++ {})\n", TUMBLE_VERSION, TUMBLE_BUILD_TYPE, __VERSION__);
    fmt::print("  {:<16} {}\n", "libraries", versions());

    const Finding shaders = look_for_shaders();
    const Finding osmesa = try_drawing(GlBackend::osmesa);
    const Finding egl = try_drawing(GlBackend::egl);
    const Finding ffmpeg = look_for_ffmpeg();
    print("shaders", shaders, "set TUMBLE_SHADERS to the folder of that name, or install Tumble again");
    print("OpenGL, osmesa", osmesa, "apt-get install libosmesa6");
    print("OpenGL, egl", egl, "apt-get install libegl1 libgl1-mesa-dri   (only for --gl egl)");
    print("ffmpeg", ffmpeg, "apt-get install ffmpeg   (frames can be written without it)");

    const bool able = shaders.good && osmesa.good && ffmpeg.good;
    fmt::print("{}\n", able ? "Everything is there: tumble render works here." : "tumble render does not work here yet.");
    return able ? 0 : 1;
}

}  // namespace tumble
