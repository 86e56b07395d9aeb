#include "page/clip_data.h"

#include "page/crack_marks.h"
#include "page/environment_data.h"
#include "page/joint_marks.h"
#include "page/motion_data.h"
#include "page/scene_data.h"
#include "page/table_data.h"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

using Json = ArrayStore::Json;

// Bytes of impacts with all digits and of the bodies' events, compressed, and the most that a run has for them: less if
// many bodies move, because their motion takes the rest of the page.
constexpr std::size_t bytes_of_impact = 110, bytes_of_event = 140;
constexpr std::size_t least_precise = 30'000, most_precise = 160'000, less_by_body = 1'300;

Json settings_json(const PageRun& run) {
    const SimulationSettings& simulation = run.scene.simulation;
    return {{"impacts", simulation.impacts == ImpactMode::exact ? "exact" : "stepped"},
            {"method", simulation.method == SimulationMethod::notes ? "notes" : "tumble"},
            {"integrator", run.integrator},
            {"step", run.scene.step()},
            {"gravity", vector_json(simulation.gravity)}};
}

/// True if impacts have all digits, and the bodies' events are part of the data.
bool has_precise_impacts(const PageRun& run) {
    std::size_t bytes = std::size_t(run.all_impacts) * bytes_of_impact, moving = 0;
    for (const BodyRecord& body : run.bodies) {
        if (!body.all_events) return false;
        bytes += body.events.size() * bytes_of_event;
        moving += body.samples.size() > 1;
    }
    return bytes <= std::max(least_precise, most_precise - std::min(most_precise, less_by_body * moving));
}

Json run_json(const PageRun& run, const PageClip& clip, MeshTable& meshes, ArrayStore& arrays, MotionErrors& errors) {
    const bool precise = has_precise_impacts(run);
    MotionData motion = make_motion_data(run, clip.motion_budget, precise, arrays);
    errors.add(motion.errors);
    Json json{{"label", run.label},
              {"fps", run.scene.output.fps},
              {"frames", run.frames},
              {"settings", settings_json(run)},
              {"bodies", make_bodies(run, meshes)},
              {"cords", make_cords(run)},
              {"light", make_light(run)},
              {"camera", make_camera(run, arrays)},
              {"motion", std::move(motion.json)},
              {"energy", make_energy_data(run, arrays)},
              {"joints", make_joint_data(run, arrays)},
              {"impacts", make_impact_data(run, precise, arrays)},
              {"all_impacts", run.all_impacts},
              {"contacts", make_contact_data(run, arrays)},
              {"all_contacts", run.all_contacts},
              {"loads", make_load_data(run, arrays)},
              {"joint_marks", make_joint_marks(run, arrays)},
              {"overlays", make_overlays(run)}};
    if (!run.pace.empty()) json["pace"] = run.pace;
    if (Json cracks = make_crack_marks(run.scene, arrays); !cracks.empty()) json["cracks"] = std::move(cracks);
    if (run.scene.water) json["water"] = make_water(run.scene);
    if (run.scene.environment) json["environment"] = make_environment(*run.scene.environment, arrays);
    if (run.scene.output.exposure) json["exposure"] = *run.scene.output.exposure;
    if (run.scene.output.tone == ToneCurve::linear) json["tone"] = "linear";
    return json;
}

}  // namespace

ClipData make_clip_container(const PageClip& clip) {
    ArrayStore arrays;
    MeshTable meshes;
    ClipData data;
    Json header{{"format", 1}, {"title", clip.title}, {"generator", clip.generator}};
    header["sources"] = Json::array();
    for (const PageSource& source : clip.sources)
        header["sources"].push_back({{"name", source.name}, {"text", source.text}});
    header["runs"] = Json::array();
    for (const PageRun& run : clip.runs) header["runs"].push_back(run_json(run, clip, meshes, arrays, data.errors));
    header["meshes"] = meshes.write(arrays);
    if (Json textures = meshes.write_textures(arrays); !textures.empty()) header["textures"] = std::move(textures);
    const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::vector<std::byte>& bytes = data.bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(std::byte(text.size() >> shift & 0xffu));
    for (const char c : text) bytes.push_back(std::byte(c));
    bytes.insert(bytes.end(), arrays.bytes().begin(), arrays.bytes().end());
    return data;
}

}  // namespace tumble
