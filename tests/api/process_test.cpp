// The library leaves the process of its caller alone.
#include "scenes.h"
#include "support/folder.h"

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
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);  // no child: ECHILD
    EXPECT_EQ(errno, ECHILD);
}

// The importer of such a file runs in a child process.
TEST(Process, IsForkedOnlyWhereThatIsAllowed) {
    const TestFolder folder;
    write_text(folder / "a.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    SceneSpec spec;
    spec.folder = folder.path();
    spec.add(Mesh{"a.off"});
    try {
        const Scene refused(spec);
        ADD_FAILURE() << "it was read";
    } catch (const Error& error) {
        EXPECT_EQ(error.where().element, "bodies[0].shape.file");
        EXPECT_NE(error.message().find("needs an import in a child process"), std::string::npos) << error.what();
    }
    write_text(folder / "scene.toml", to_toml(spec));
    EXPECT_THROW(load_scene(folder / "scene.toml"), Error);
    spec.allow_import_process = true;
    EXPECT_EQ(Scene(spec).body_count(), 1u);
    LoadOptions options;
    options.allow_import_process = true;
    EXPECT_EQ(load_scene(folder / "scene.toml", options).body_count(), 1u);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
}

}  // namespace
}  // namespace tumble
