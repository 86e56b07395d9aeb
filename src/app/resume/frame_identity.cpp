#include "app/resume/frame_identity.h"

#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "core/sha256.h"
#include "output/file_bytes.h"
#include "scene/hash/scene_hash.h"
#include "tumble/version.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

constexpr int manifest_format = 1;

void add(Sha256& hash, const std::string& text) { hash.add(fmt::format("{}:{}", text.size(), text)); }

void add(Sha256& hash, const NamedValues& values) {
    for (const auto& [name, value] : values) {
        add(hash, name);
        add(hash, value);
    }
}

/// Text, plots and scales of arrows are laid out for the whole clip, panels end with their scenes, and the path of a
/// camera behind a body ends with the clip.
bool depends_on_duration(std::span<const ClipScene> scenes) {
    return scenes.size() > 1 || std::ranges::any_of(scenes, [](const ClipScene& one) {
               const OverlayDescription& overlay = one.scene->overlay;
               return !overlay.show.empty() || !overlay.plot.empty() || !overlay.captions.empty() || overlay.fade_out ||
                      one.scene->camera.any_lags();
           });
}

void list_settings(const NamedValues& there, const NamedValues& here, std::vector<std::string>& list) {
    for (const auto& [name, value] : here) {
        const std::string* other = find_value(there, name);
        if (other == nullptr || *other != value)
            list.push_back(fmt::format("{} ({} there, {} here)", name, other == nullptr ? "none" : safe_text(*other),
                                       safe_text(value)));
    }
    for (const auto& [name, value] : there)
        if (find_value(here, name) == nullptr)
            list.push_back(fmt::format("{} ({} there, none here)", safe_text(name), safe_text(value)));
}

Json json_of_values(const NamedValues& values) {
    Json json = Json::object();
    for (const auto& [name, value] : values) json[name] = value;
    return json;
}

NamedValues values_of(const Json& json) {
    NamedValues values;
    for (const auto& [name, value] : json.items()) values.emplace_back(name, value.get<std::string>());
    return values;
}

}  // namespace

std::string FrameIdentity::mark() const {
    Sha256 hash;
    add(hash, "tumble frame");
    add(hash, version);
    for (const Scene& scene : scenes) {
        add(hash, scene.label);
        add(hash, scene.parts);
    }
    add(hash, settings);
    return hash.finish();
}

FrameIdentity identity_of(std::span<const ClipScene> scenes, const NamedValues& settings) {
    FrameIdentity identity;
    identity.version = v0::version();
    for (const ClipScene& one : scenes) {
        const SceneDescription& scene = *one.scene;
        FrameIdentity::Scene& entry = identity.scenes.emplace_back();
        entry.file = std::filesystem::path(scene.file).filename().string();
        entry.label = one.label;
        entry.hash = scene_hash(scene);
        entry.parts = scene_parts(scene);
        entry.parts.emplace_back("frames per second", fps_text(scene.output.fps));
        entry.parts.emplace_back("samples", fmt::format("{}", scene.output.samples));
        entry.parts.emplace_back("frames of the motion",
                                 fmt::format("{} x {}", one.timing.fps, one.timing.steps_per_frame));
        if (depends_on_duration(scenes))
            entry.parts.emplace_back("duration", fmt::format("{}", scene.simulation.duration));
    }
    identity.settings = settings;
    return identity;
}

std::string differences(const FrameIdentity& there, const FrameIdentity& here) {
    std::vector<std::string> list;
    if (there.version != here.version)
        list.push_back(
            fmt::format("the version of the program ({} there, {} here)", safe_text(there.version), here.version));
    if (there.scenes.size() != here.scenes.size())
        list.push_back(
            fmt::format("the number of scenes ({} there, {} here)", there.scenes.size(), here.scenes.size()));
    for (std::size_t i = 0; i < std::min(there.scenes.size(), here.scenes.size()); ++i) {
        const FrameIdentity::Scene &a = there.scenes[i], &b = here.scenes[i];
        if (a.label != b.label) list.push_back(fmt::format("the label of panel {}", i + 1));
        for (const auto& [name, value] : b.parts) {
            const std::string* other = find_value(a.parts, name);
            if (other != nullptr && *other == value) continue;
            const bool readable = other != nullptr && value.size() < 40;  // others are hashes
            list.push_back(fmt::format("the {} of {}{}", name, safe_path(b.file),
                                       readable ? fmt::format(" ({} there, {} here)", safe_text(*other), value) : ""));
        }
    }
    list_settings(there.settings, here.settings, list);
    return list.empty() ? "unknown values" : fmt::format("{}", fmt::join(list, ", "));
}

std::string manifest_text(const FrameIdentity& identity) {
    Json scenes = Json::array();
    for (const FrameIdentity::Scene& scene : identity.scenes)
        scenes.push_back({{"file", scene.file},
                          {"label", scene.label},
                          {"hash", scene.hash},
                          {"parts", json_of_values(scene.parts)}});
    const Json json = {{"format", manifest_format},  {"version", identity.version},
                       {"mark", identity.mark()},    {"frames", identity.frames},
                       {"fps", identity.fps},        {"settings", json_of_values(identity.settings)},
                       {"scenes", std::move(scenes)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<FrameIdentity> read_manifest(const std::filesystem::path& path) {
    const std::optional<std::string> text = bytes_of_file(path);
    if (!text) return std::nullopt;
    try {
        const Json json = Json::parse(*text);
        if (json.at("format") != manifest_format) return std::nullopt;
        FrameIdentity identity;
        identity.version = json.at("version").get<std::string>();
        identity.frames = json.at("frames").get<std::int64_t>();
        identity.fps = json.at("fps").get<double>();
        identity.settings = values_of(json.at("settings"));
        for (const Json& scene : json.at("scenes"))
            identity.scenes.push_back({scene.at("file").get<std::string>(), scene.at("label").get<std::string>(),
                                       scene.at("hash").get<std::string>(), values_of(scene.at("parts"))});
        if (json.at("mark") != identity.mark()) return std::nullopt;
        return identity;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

}  // namespace tumble
