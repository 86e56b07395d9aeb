#include "app/sweep/sample_maker.h"

#include "api/scene_data.h"
#include "app/files/run_tables.h"
#include "app/sweep/sample_clip.h"
#include "app/sweep/sample_folder.h"
#include "app/sweep/sweep_plan.h"
#include "app/sweep/toml_json.h"
#include "output/output_path.h"
#include "scene/description/description.h"
#include "scene/hash/scene_hash.h"
#include "scene/toml/set_values.h"
#include "scene/toml/toml_text.h"

#include <fmt/format.h>

#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The name of a file for a scene in another folder.
void move_file(toml::value<std::string>* file, const fs::path& from, const fs::path& to) {
    if (file == nullptr) return;
    const fs::path name(file->get());
    if (name.empty() || name.is_absolute()) return;
    file->get() = fs::absolute(from / name).lexically_normal().lexically_relative(fs::absolute(to).lexically_normal());
}

/// Files of meshes and of poses.
void move_files(toml::node& node, const fs::path& from, const fs::path& to) {
    if (toml::table* table = node.as_table()) {
        toml::table& keys = *table;
        if (keys["type"].value<std::string>() == "mesh") move_file(keys["file"].as_string(), from, to);
        move_file(keys["poses"].as_string(), from, to);
        for (auto&& [key, inner] : keys) move_files(inner, from, to);
    } else if (toml::array* array = node.as_array()) {
        for (toml::node& inner : *array) move_files(inner, from, to);
    }
}

/// As TOML, for `tumble render`, or as JSON for other programs. `folder`: where the text will be; names of files
/// become relative to it. Throws InputError.
std::string resolved_scene(const std::string& text, const fs::path& scene, const std::vector<std::string>& assignments,
                           const fs::path& folder, SceneForm form) {
    toml::table document = parse_toml(text, scene.string());
    set_values(document, assignments);
    move_files(document, scene.parent_path(), folder);
    if (form == SceneForm::json) return json_of(document).dump(2) + "\n";
    return toml_document_text(document);
}

/// The assignment of a title, for a scene without one: a copy under another file name shows the same title.
std::vector<std::string> title_assignment(const std::string& text, const fs::path& scene) {
    const toml::table document = parse_toml(text, scene.string());
    if (document.contains("title")) return {};
    return {"title=" + toml_string(scene.stem().string())};
}

/// Simulates the scene and writes the requested tables.
void write_tables(const std::shared_ptr<const SceneDescription>& description, const SampleOutputs& outputs,
                  SampleFolder& folder) {
    const std::string ending = outputs.arrays ? ".npz" : ".csv";
    TableFiles files;
    if (outputs.trajectory) files.trajectory = folder.path() / "trajectory.csv";
    if (outputs.energy) files.energy = folder.path() / "energy.csv";
    if (outputs.impacts) files.impacts = folder.path() / ("impacts" + ending);
    if (outputs.contacts) files.contacts = folder.path() / ("contacts" + ending);
    if (outputs.loads) files.loads = folder.path() / ("loads" + ending);
    if (outputs.joints) files.joints = folder.path() / ("joints" + ending);
    const v0::Scene scene = v0::make_scene(description, {});
    World world(*description, 1);
    RunTables tables(files, scene);
    tables.start_records(world);
    const std::int64_t frames = scene.frame_count();
    for (std::int64_t n = 0; n < frames; ++n) {
        if (n > 0) world.advance_frame();
        tables.add(n, world);
    }
    tables.finish();
    for (const std::filesystem::path& file : files.all()) folder.add(file.filename().string());
}

}  // namespace

SampleMaker::SampleMaker(const SweepPlan& plan, std::string scene, fs::path folder)
    : plan_(plan), text_(std::move(scene)), title_(title_assignment(text_, plan.scene)), folder_(std::move(folder)) {}

SampleMaker::~SampleMaker() = default;

fs::path SampleMaker::hidden_folder(const fs::path& folder) { return folder / ".tumble-sweep"; }

GlDevice& SampleMaker::device() {
    if (!device_) device_ = std::make_unique<GlDevice>(plan_.drawing.backend);
    return *device_;
}

RenderScenes SampleMaker::load(const SweepSample& sample) const {
    ClipRequest request;
    request.scenes = {plan_.scene};
    request.text = text_;
    request.aovs = plan_.outputs.aovs;
    request.start = plan_.drawing.start;
    request.speed = plan_.drawing.speed;
    request.overrides.set = title_;
    for (std::string& assignment : sample.assignments(plan_)) request.overrides.set.push_back(std::move(assignment));
    return {request, shutter_of(plan_.drawing)};
}

bool SampleMaker::make(std::int64_t index, Known known) {
    SampleRecord record;
    record.sample = sample_of(plan_, index);
    const SweepSample& sample = record.sample;
    RenderScenes scenes = load(sample);
    record.scene_hash = scene_hash(scenes.first());
    record.identity = identity_of(plan_, sample, record.scene_hash);
    const fs::path place = folder_ / sample.name;
    if (const fs::path above = fs::path(sample.name).parent_path(); !above.empty())
        confined_path(folder_, above / record_name);
    if (known == Known::kept) {
        const auto there = read_sample_record(place);
        if (there && there->identity == record.identity && files_are_whole(place, there->files)) return false;
    }
    SampleFolder folder(hidden_folder(folder_) / fmt::format("{}-{}", index, ::getpid()));
    record.figures = write_files(sample, scenes, folder);
    record.files = folder.files();
    folder.write(record_name, record_text(plan_, record) + "\n");
    folder.publish(place);
    return true;
}

SampleFigures SampleMaker::write_files(const SweepSample& sample, RenderScenes& scenes, SampleFolder& folder) {
    const SceneDescription& scene = scenes.first();
    SampleFigures figures;
    figures.frames = plan_.outputs.drawn() ? scenes.frames.count() : scene.frame_count();
    figures.bodies = std::int64_t(scene.bodies.size());
    figures.width = scene.output.width;
    figures.height = scene.output.height;
    figures.fps = scene.output.fps;
    figures.duration = scene.simulation.duration;
    if (plan_.outputs.scene != SceneForm::none) {
        std::vector<std::string> assignments = title_;
        for (std::string& assignment : sample.assignments(plan_)) assignments.push_back(std::move(assignment));
        folder.write(plan_.outputs.scene == SceneForm::json ? "scene.json" : "scene.toml",
                     resolved_scene(text_, plan_.scene, assignments, folder_ / sample.name, plan_.outputs.scene));
    }
    if (plan_.outputs.drawn()) {
        const bool image = plan_.outputs.frames || !plan_.outputs.clip.empty();
        scenes.survey_clip({.image = image}, interrupt_);
        try {
            figures.drawn = write_clip(plan_, scenes, image ? &device() : nullptr, folder);
        } catch (...) {
            device_.reset();  // in whatever state the drawing left it
            throw;
        }
    }
    if (plan_.outputs.tables()) write_tables(scenes.scenes.front().scene, plan_.outputs, folder);
    return figures;
}

}  // namespace tumble
