#include "app/clip/drawing_settings.h"

#include "core/child_process.h"
#include "core/error.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cerrno>
#include <string>

namespace tumble {
namespace {

/// In a child: drivers start threads, and a process that forks later must have no other thread.
bool uses_gpu(GlBackend backend) {
    if (backend != GlBackend::egl) return false;
    const pid_t child = fork_child({}, [backend] {
        try {
            return draws_on_cpu(backend) ? 0 : 1;
        } catch (const RunError&) {
            return 1;
        }
    });
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return !(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace

NamedValues drawing_settings(const ClipRequest& request, const DrawingChoices& choices,
                             const Composition& composition) {
    const auto yes = [](bool value) { return std::string(value ? "yes" : "no"); };
    NamedValues settings{{"size", fmt::format("{}x{}", composition.width, composition.height)},
                         {"speed", fmt::format("{}", request.speed)},
                         {"shutter", fmt::format("{}", choices.shutter)},
                         {"transparent", yes(choices.transparent)},
                         {"gl", uses_gpu(choices.backend) ? "egl" : "osmesa"}};
    if (choices.shutter > 0.0) settings.emplace_back("blur samples", fmt::format("{}", choices.blur_samples));
    if (request.scenes.size() > 1 || !request.vary.empty())
        settings.emplace_back("layout", request.arrangement == PanelArrangement::row    ? "row"
                                        : request.arrangement == PanelArrangement::grid ? "grid"
                                                                                        : "automatic");
    return settings;
}

FrameIdentity identity_of_aovs(FrameIdentity pictures, const AovSet& aovs) {
    pictures.settings.emplace_back("AOVs", names_of(aovs));
    return pictures;
}

}  // namespace tumble
