#include "app/lesson/lesson_scene.h"

#include "app/plots/variants.h"
#include "core/input_file.h"
#include "core/safe_text.h"
#include "presimulation/impact_focus.h"
#include "quantities/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace tumble {
namespace {

void check_body(const SceneDescription& scene, const std::string& name, const char* key, const BlockPlaces& places) {
    if (name.empty() || std::ranges::any_of(scene.bodies, [&](const BodyDescription& b) { return b.name == name; }))
        return;
    throw InputError(places.of(key), fmt::format("{}: no body of the scene has the name '{}'", key, safe_text(name)));
}

void check_options(const LessonStage& stage, const std::vector<LoadedScene>& scenes) {
    const SceneDescription& first = scenes.front().scene;
    const PlayerOptions& options = stage.options;
    check_body(first, options.follow, "follow", stage.places);
    check_body(first, options.body, "body", stage.places);
    if (!options.plot.empty())
        with_place(stage.places.of("plot"), "plot", [&] { parse_quantities(options.plot, first); });
    if (std::size_t(options.run) >= scenes.size())
        throw InputError(stage.places.of("run"), fmt::format("run: the stage has {} runs, numbered from 0 (given {})",
                                                             scenes.size(), options.run));
    if (options.time > first.simulation.duration)
        throw InputError(stage.places.of("time"), fmt::format("time: the run ends at {:g} s (given {:g})",
                                                              first.simulation.duration, options.time));
}

}  // namespace

void with_place(const SourceLocation& place, const std::string& key, const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        if (!error.where().file.empty()) throw;
        throw InputError(place, fmt::format("{}: {}", key, error.message()));
    }
}

SceneDescription load_lesson_scene(const LessonScene& scene, const SceneOverrides& overrides, const BlockPlaces& places,
                                   FileList& read) {
    SceneDescription loaded;
    if (!scene.text && !std::filesystem::exists(scene.file))
        throw InputError(places.of("scene"), fmt::format("scene: there is no file {}", safe_path(scene.file)));
    const std::string key = scene.set.empty() && places.keys.count("vary") > 0 ? "vary" : "set";
    with_place(places.of(key), key, [&] {
        loaded = focused_on_impacts(scene.text ? parse_scene(*scene.text, scene.file, overrides, &read)
                                               : load_scene(scene.file, overrides, &read));
    });
    return loaded;
}

std::vector<LoadedScene> load_stage(const LessonStage& stage, FileList& read) {
    SceneOverrides overrides;
    overrides.set = stage.scene.set;
    std::vector<Variant> variants;
    with_place(stage.places.of("vary"), "vary",
               [&] { variants = make_variants(std::span(&stage.scene.file, 1), overrides, stage.vary); });
    with_place(stage.places.of("labels"), "labels", [&] { label_variants(variants, stage.labels); });
    std::vector<LoadedScene> scenes;
    for (const Variant& variant : variants)
        scenes.push_back({load_lesson_scene(stage.scene, variant.overrides, stage.places, read), variant.overrides,
                          variants.size() > 1 ? variant.label : ""});
    check_options(stage, scenes);
    return scenes;
}

std::vector<LiveControl> load_live_controls(const LessonStage& stage) {
    std::vector<LiveControl> controls = stage.live;
    if (controls.empty()) return controls;
    SceneOverrides overrides;
    overrides.set = stage.scene.set;
    try {
        complete_live_controls(controls, scene_source(stage.scene), stage.id + ".toml", overrides);
    } catch (const InputError& error) {
        throw InputError(stage.places.of("live"), fmt::format("live: {}", error.message()));
    }
    return controls;
}

std::string scene_source(const LessonScene& scene) {
    std::string text = scene.text ? *scene.text : read_input_file(scene.file, "the scene");
    text.erase(0, std::min(text.find_first_not_of('\n'), text.size()));
    // The lines of the page's own keys left gaps.
    for (std::size_t gap; scene.text && (gap = text.find("\n\n\n")) != std::string::npos;) text.erase(gap, 1);
    return text;
}

}  // namespace tumble
