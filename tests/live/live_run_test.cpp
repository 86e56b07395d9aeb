// A run that a page makes itself has the data that `tumble page` puts into a page.
#include "live/live_run.h"
#include "app/page/record_run.h"
#include "core/error.h"
#include "scene/load.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace tumble::live_run_test {
namespace {

using Bytes = std::vector<std::byte>;

std::filesystem::path scene_file(const std::string& name) {
    return std::filesystem::path(TUMBLE_SOURCE_DIR) / "assets/scenes" / name;
}

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// The data of the page of that scene, as record_page() makes it.
Bytes recorded(const std::filesystem::path& file, const std::vector<std::string>& settings) {
    SceneOverrides overrides;
    overrides.set = settings;
    const SceneDescription scene = load_scene(file, overrides);
    PageClip clip{scene.title.empty() ? file.stem().string() : scene.title,
                  "Tumble " TUMBLE_VERSION,
                  {{file.filename().string(), text_of(file)}},
                  {}};
    std::string options;
    for (const std::string& setting : settings) options += "--set " + setting + "\n";
    if (!options.empty()) clip.sources.push_back({"Options of the command line", options});
    Interrupt interrupt;
    clip.runs.push_back(record_run(
        scene, {.threads = 2, .label = "", .progress = {}, .observers = {}, .plot = scene.overlay.plot}, interrupt));
    return make_clip_container(clip).bytes;
}

Bytes live(const std::filesystem::path& file, const std::vector<std::string>& settings, std::int64_t piece) {
    std::filesystem::current_path(file.parent_path());  // of its meshes: the page has the name alone
    LiveRun run(file.filename().string(), text_of(file), settings);
    while (run.frames() < run.all_frames()) run.advance(piece);
    return run.data();
}

TEST(LiveRun, HasTheDataOfAPage) {
    for (const char* name : {"bouncing_balls.toml", "falling_boxes.toml", "ragdoll.toml"}) {
        const std::vector<std::string> settings{"simulation.duration=0.6"};
        EXPECT_TRUE(live(scene_file(name), settings, 7) == recorded(scene_file(name), settings)) << name;
    }
}

TEST(LiveRun, HasTheCameraOfTheWholeMotion) {
    const auto scene = scene_file("newtons_cradle.toml");
    EXPECT_TRUE(live(scene, {}, 1000) == recorded(scene, {}));
}

TEST(LiveRun, DoesNotDependOnThePieces) {
    const std::vector<std::string> settings{"simulation.impacts=exact", "simulation.duration=0.5"};
    const auto scene = scene_file("bouncing_balls.toml");
    EXPECT_TRUE(live(scene, settings, 1) == live(scene, settings, 1000));
}

TEST(LiveRun, NamesThePlaceOfAMistake) {
    try {
        LiveRun("ball.toml", "format = 1\n[simulation]\nduration = -1\n", {});
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().line, 3);
        EXPECT_EQ(error.where().column, 12);
    }
}

}  // namespace
}  // namespace tumble::live_run_test
