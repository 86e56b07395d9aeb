#include "app/sweep/sample_tables.h"

#include "api/scene_data.h"
#include "app/files/run_tables.h"

namespace tumble {

void write_tables(const SceneDescription& description, const SampleOutputs& outputs, SampleFolder& folder) {
    const std::string ending = outputs.arrays ? ".npz" : ".csv";
    TableFiles files;
    if (outputs.trajectory) files.trajectory = folder.path() / "trajectory.csv";
    if (outputs.energy) files.energy = folder.path() / "energy.csv";
    if (outputs.impacts) files.impacts = folder.path() / ("impacts" + ending);
    if (outputs.contacts) files.contacts = folder.path() / ("contacts" + ending);
    if (outputs.loads) files.loads = folder.path() / ("loads" + ending);
    const v0::Scene scene = v0::make_scene(description, {});
    World world(description, 1);
    RunTables tables(files, scene);
    if (tables.needs_records()) world.record_contacts();
    const std::int64_t frames = scene.frame_count();
    for (std::int64_t n = 0; n < frames; ++n) {
        if (n > 0) world.advance_frame();
        tables.add(n, world);
    }
    tables.finish();
    for (const std::filesystem::path& file : files.all()) folder.add(file.filename().string());
}

}  // namespace tumble
