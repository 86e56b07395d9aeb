#include "app/sweep/sample_maker.h"

#include "app/sweep/resolved_scene.h"
#include "app/sweep/sample_clip.h"
#include "app/sweep/sample_tables.h"
#include "output/confined_path.h"
#include "scene/hash/scene_hash.h"

#include <fmt/format.h>

#include <unistd.h>

#include <utility>

namespace tumble {

namespace fs = std::filesystem;

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
        if (image) scenes.survey_clip(1, interrupt_);
        try {
            figures.drawn = write_clip(plan_, scenes, image ? &device() : nullptr, folder);
        } catch (...) {
            device_.reset();  // in whatever state the drawing left it
            throw;
        }
    }
    if (plan_.outputs.tables()) write_tables(scene, plan_.outputs, folder);
    return figures;
}

}  // namespace tumble
