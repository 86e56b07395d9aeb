#include "app/cli/run_tables.h"

#include "api/convert.h"
#include "app/files/output_plan.h"

namespace tumble {

RunTables::RunTables(const SimulateCommand& command, const v0::Scene& scene, std::int64_t first)
    : fps_(scene.output().fps), first_(first) {
    if (command.trajectory) trajectory_.emplace(*command.trajectory, scene);
    if (command.energy) energy_.emplace(*command.energy, scene);
    if (command.impacts) impacts_.emplace(*command.impacts, scene);
    if (command.contacts) contacts_.emplace(*command.contacts, scene);
    if (command.loads) loads_.emplace(*command.loads, scene);
    if (command.joints) joints_.emplace(*command.joints, scene);
}

void RunTables::plan(const SimulateCommand& command, OutputPlan& plan) {
    if (command.trajectory) plan.add("--trajectory", *command.trajectory);
    if (command.energy) plan.add("--energy", *command.energy);
    if (command.impacts) plan.add("--impacts", *command.impacts);
    if (command.contacts) plan.add("--contacts", *command.contacts);
    if (command.loads) plan.add("--loads", *command.loads);
    if (command.joints) plan.add("--joints", *command.joints);
}

std::vector<std::filesystem::path> RunTables::files(const SimulateCommand& command) {
    std::vector<std::filesystem::path> files;
    for (const auto& file :
         {command.trajectory, command.energy, command.impacts, command.contacts, command.loads, command.joints})
        if (file) files.push_back(*file);
    return files;
}

void RunTables::add(std::int64_t frame, const World& world) {
    const double time = double(frame) / fps_;
    if (trajectory_) trajectory_->add(v0::to_public(world.snapshot()));
    if (energy_) energy_->add(frame, time, v0::to_public(world.measure(), world.contact_records().energy));
    if (joints_) joints_->add(frame, time, v0::to_public(world.joint_states()));
    if (!impacts_ && !contacts_ && !loads_) return;
    v0::FrameContacts contacts = v0::to_public(world.contact_records());
    std::erase_if(contacts.impacts, [&](const v0::Impact& impact) { return impact.frame < first_; });
    if (impacts_) impacts_->add(contacts);
    if (contacts_) contacts_->add(frame, time, contacts);
    if (loads_) loads_->add(frame, time, contacts);
}

void RunTables::finish() {
    if (trajectory_) trajectory_->finish();
    if (energy_) energy_->finish();
    if (impacts_) impacts_->finish();
    if (contacts_) contacts_->finish();
    if (loads_) loads_->finish();
    if (joints_) joints_->finish();
}

}  // namespace tumble
