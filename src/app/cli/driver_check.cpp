#include "app/cli/driver_check.h"

#include "core/error.h"
#include "core/image.h"
#include "core/memory_limit.h"
#include "scene/description/description.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <new>

namespace tumble {
namespace {

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

}  // namespace

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

}  // namespace tumble
