#include "app/cli/page_recording.h"

#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/page/record_run.h"
#include "app/plots/alike_runs.h"
#include "app/plots/quantities.h"
#include "core/error.h"
#include "core/frame_rate.h"
#include "core/input_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The options of the command line that change the scenes, one a line; empty: none.
std::string options_text(const SceneOverrides& overrides, std::span<const std::string> vary) {
    std::string text;
    const auto add = [&](const char* option, const auto& value) {
        if (value) text += fmt::format("{} {}\n", option, *value);
    };
    add("--method", overrides.method);
    add("--integrator", overrides.integrator);
    add("--duration", overrides.duration);
    if (overrides.fps) text += fmt::format("--fps {}\n", fps_text(*overrides.fps));
    for (const std::string& value : overrides.set) text += fmt::format("--set {}\n", value);
    for (const std::string& values : vary) text += fmt::format("--vary {}\n", values);
    add("--overlay", overrides.overlay);
    add("--plot", overrides.plot);
    return text;
}

void check_plot(const SceneDescription& scene, const SceneOverrides& overrides) {
    try {
        if (!scene.overlay.plot.empty()) parse_quantities(scene.overlay.plot, scene);
    } catch (const InputError& error) {
        if (overrides.plot) throw InputError(fmt::format("--plot: {}", error.message()));
        throw InputError({scene.file, 0, 0}, fmt::format("[overlay] plot: {}", error.message()));
    }
}

}  // namespace

double PageScenes::duration() const {
    double longest = 0.0;
    for (const SceneDescription& scene : scenes) longest = std::max(longest, scene.simulation.duration);
    return longest;
}

std::string PageScenes::title() const {
    const std::string& given = scenes.front().title;
    return given.empty() ? variants.front().scene.stem().string() : given;
}

PageScenes load_page_scenes(std::span<const fs::path> files, const SceneOverrides& overrides,
                            std::span<const std::string> vary, std::span<const std::string> labels) {
    PageScenes page;
    page.vary.assign(vary.begin(), vary.end());
    page.variants = make_variants(files, overrides, vary);
    try {
        label_variants(page.variants, labels);
    } catch (const InputError& error) {
        throw InputError(fmt::format("--label: {}", error.message()));
    }
    for (const Variant& variant : page.variants) {
        page.scenes.push_back(load_scene(variant.scene, variant.overrides, &page.inputs));
        check_plot(page.scenes.back(), overrides);
    }
    for (const fs::path& file : files)
        page.sources.push_back({file.filename().string(), read_input_file(file, "the scene")});
    const std::string options = options_text(overrides, vary);
    if (!options.empty()) page.sources.push_back({"Options of the command line", options});
    return page;
}

PageClip record_page(const PageScenes& scenes, int threads, bool quiet, Interrupt& interrupt) {
    PageClip clip;
    clip.title = scenes.title();
    clip.generator = "Tumble " TUMBLE_VERSION;
    clip.sources = scenes.sources;
    std::int64_t total = 0, before = 0;
    for (const SceneDescription& scene : scenes.scenes) total += scene.frame_count();
    Progress progress(total, quiet);
    AlikeRuns alike(scenes.vary);
    for (std::size_t i = 0; i < scenes.scenes.size(); ++i) {
        RecordSettings settings;
        settings.threads = threads;
        settings.label = scenes.variants[i].label;
        settings.plot = scenes.scenes[i].overlay.plot;
        if (!scenes.vary.empty()) settings.observers.push_back(&alike.add(settings.label, scenes.scenes[i]));
        settings.progress = [&](std::int64_t done) { progress.update(before + done); };
        clip.runs.push_back(record_run(scenes.scenes[i], settings, interrupt));
        before += scenes.scenes[i].frame_count();
    }
    if (!quiet) say_text(alike.warning());
    return clip;
}

}  // namespace tumble
