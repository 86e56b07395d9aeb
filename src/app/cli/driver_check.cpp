#include "app/cli/driver_check.h"

#include "core/available_memory.h"
#include "core/child_process.h"
#include "core/error.h"
#include "core/image.h"
#include "scene/description/description.h"

#include <cstring>
#include <new>

namespace tumble {
namespace {

constexpr int failed = 1, out_of_memory = 3;  // exit codes of a check

/// Runs a check in the child process.
int run_check(const std::function<std::string()>& check, int pipe) {
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
    return write_all(pipe, text) ? code : failed;
}

}  // namespace

Finding in_own_process(const char* library, const std::function<std::string()>& check, TimeLimit& time_limit) {
    ProgramOutput output;
    try {
        Pipe pipe;
        const pid_t id = fork_child({}, [&] {
            pipe.close_read();
            return run_check(check, pipe.write_end());
        });
        pipe.close_write();
        output = time_limit.listen(id, pipe.read_end());
    } catch (const RunError& error) {
        return {false, error.message()};
    }
    if (output.stopped) return time_limit.late(library);
    if (output.end.signal == 0) return {output.end.ok(), output.text, output.end.exit_code != out_of_memory};
    const std::string limit = memory_limit_note();
    return {false, fmt::format("{} crashed ({}){}", library, strsignal(output.end.signal), limit), limit.empty()};
}

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
    return in_own_process("the driver", check, time_limit);
}

}  // namespace tumble
