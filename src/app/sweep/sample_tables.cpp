#include "app/sweep/sample_tables.h"

#include "api/scene_data.h"
#include "tumble/output.h"
#include "tumble/world.h"

#include <optional>
#include <string>

namespace tumble {

void write_tables(const SceneDescription& description, const SampleOutputs& outputs, SampleFolder& folder) {
    const v0::Scene scene = v0::make_scene(description, {});
    v0::World world(scene, 1);
    if (outputs.energy || outputs.impacts || outputs.contacts || outputs.loads) world.record_contacts();
    std::vector<std::string> names;
    const auto open = [&]<class Table, class... Of>(bool wanted, std::optional<Table>& table, const std::string& name,
                                                    const Of&... of) {
        if (!wanted) return;
        names.push_back(name);
        table.emplace((folder.path() / name).string(), of...);
    };
    const std::string ending = outputs.arrays ? ".npz" : ".csv";
    std::optional<v0::TrajectoryTable> trajectory;
    std::optional<v0::EnergyTable> energy;
    std::optional<v0::ImpactTable> impacts;
    std::optional<v0::ContactTable> contacts;
    std::optional<v0::LoadTable> loads;
    open(outputs.trajectory, trajectory, "trajectory.csv", scene);
    open(outputs.energy, energy, "energy.csv");
    open(outputs.impacts, impacts, "impacts" + ending, scene);
    open(outputs.contacts, contacts, "contacts" + ending, scene);
    open(outputs.loads, loads, "loads" + ending, scene);
    const std::int64_t frames = scene.frame_count();
    for (std::int64_t n = 0; n < frames; ++n) {
        const double time = double(n) / scene.output().fps;
        if (n > 0) world.advance_frame();
        if (trajectory) trajectory->add(world.snapshot());
        if (energy) energy->add(n, time, world.energies());
        if (impacts) impacts->add(world.contacts());
        if (contacts) contacts->add(n, time, world.contacts());
        if (loads) loads->add(n, time, world.contacts());
    }
    if (trajectory) trajectory->finish();
    if (energy) energy->finish();
    if (impacts) impacts->finish();
    if (contacts) contacts->finish();
    if (loads) loads->finish();
    for (const std::string& name : names) folder.add(name);
}

}  // namespace tumble
