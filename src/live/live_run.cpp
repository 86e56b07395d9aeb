#include "live/live_run.h"

#include "presimulation/impact_focus.h"
#include "scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace tumble {
namespace {

SceneDescription scene_of(const std::string& name, const std::string& text, const std::vector<std::string>& settings) {
    SceneOverrides overrides;
    overrides.set = settings;
    return focused_on_impacts(parse_scene(text, name, overrides, nullptr, MeshImports::refused));
}

/// As record_page() names them.
std::vector<PageSource> sources_of(const std::string& name, const std::string& text,
                                   const std::vector<std::string>& settings) {
    std::vector<PageSource> sources{{name, text}};
    std::string options;
    for (const std::string& setting : settings) options += fmt::format("--set {}\n", setting);
    if (!options.empty()) sources.push_back({"Options of the command line", options});
    return sources;
}

World recording_world(const SceneDescription& scene) {
    World world(scene);
    world.record_contacts();
    return world;
}

}  // namespace

LiveRun::LiveRun(const std::string& name, const std::string& text, const std::vector<std::string>& settings)
    : scene_(scene_of(name, text, settings)),
      sources_(sources_of(name, text, settings)),
      world_(recording_world(scene_)),
      sequence_(world_, {1, 1}),
      recorder_(scene_, {.label = "", .plot = scene_.overlay.plot, .places_camera_later = true}, world_),
      motion_camera_(scene_) {}

void LiveRun::advance(std::int64_t frames) {
    for (const std::int64_t end = std::min(frames, all_frames() - this->frames()) + this->frames();
         this->frames() < end;) {
        const Snapshot snapshot = sequence_.next_start();
        recorder_.see(snapshot, Survey(world_, recorder_.needs()), sequence_.records());
        motion_camera_.see(snapshot);
    }
}

std::vector<std::byte> LiveRun::data() const {
    PageClip clip;
    clip.title = scene_.title.empty() ? std::filesystem::path(sources_.front().name).stem().string() : scene_.title;
    clip.generator = "Tumble " TUMBLE_VERSION;
    clip.sources = sources_;
    clip.runs.push_back(recorder_.so_far(scene_.camera.any_fits_motion() ? motion_camera_.camera() : scene_.camera));
    return make_clip_container(clip).bytes;
}

}  // namespace tumble
