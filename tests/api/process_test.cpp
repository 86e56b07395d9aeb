// The library leaves the process of its caller alone.
#include "scenes.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>
#include <vector>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tumble {
namespace {

std::vector<void (*)(int)> signal_handlers() {
    std::vector<void (*)(int)> handlers;
    for (int number = 1; number < NSIG; ++number) {
        struct sigaction action {};
        ::sigaction(number, nullptr, &action);
        handlers.push_back(action.sa_handler);
    }
    return handlers;
}

std::vector<std::string> environment() {
    std::vector<std::string> values;
    for (char** value = environ; *value != nullptr; ++value) values.emplace_back(*value);
    return values;
}

TEST(Process, KeepsSignalHandlersAndEnvironmentAndHasNoChildren) {
    const auto handlers = signal_handlers();
    const auto before = environment();
    const Scene scene(crate_and_ball());
    World world(scene, 2);
    Renderer renderer(scene);
    AovRenderer aovs(scene, {true, true, true, false, true});
    for (int i = 0; i < 3; ++i) {
        world.advance_frame();
        renderer.render(world.snapshot());
        aovs.render(world.snapshot());
    }
    EXPECT_EQ(signal_handlers(), handlers);
    EXPECT_EQ(environment(), before);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);   // no child: ECHILD
    EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace tumble
