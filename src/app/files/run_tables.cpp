#include "app/files/run_tables.h"

#include "api/convert.h"
#include "app/files/output_plan.h"

namespace tumble {

std::vector<std::filesystem::path> TableFiles::all() const {
    std::vector<std::filesystem::path> files;
    for (const auto& file : {trajectory, energy, impacts, contacts, loads, joints, breaks})
        if (file) files.push_back(*file);
    return files;
}

void TableFiles::add_to(OutputPlan& plan) const {
    if (trajectory) plan.add("--trajectory", *trajectory);
    if (energy) plan.add("--energy", *energy);
    if (impacts) plan.add("--impacts", *impacts);
    if (contacts) plan.add("--contacts", *contacts);
    if (loads) plan.add("--loads", *loads);
    if (joints) plan.add("--joints", *joints);
    if (breaks) plan.add("--breaks", *breaks);
}

RunTables::RunTables(const TableFiles& files, const v0::Scene& scene, std::int64_t first)
    : fps_(scene.output().fps), first_(first), contacts_every_(files.contacts_every) {
    if (files.trajectory) trajectory_.emplace(*files.trajectory, scene);
    if (files.energy) energy_.emplace(*files.energy, scene);
    if (files.impacts) impacts_.emplace(*files.impacts, scene);
    if (files.contacts) contacts_.emplace(*files.contacts, scene);
    if (files.loads) loads_.emplace(*files.loads, scene);
    if (files.joints) joints_.emplace(*files.joints, scene);
    if (files.breaks) breaks_.emplace(*files.breaks, scene);
}

void RunTables::start_records(World& world) const {
    if (world.records_contacts()) return;
    if (needs_contacts())
        world.record_contacts();
    else if (energy_)
        world.record_energy();
}

void RunTables::add(std::int64_t frame, const World& world) {
    const double time = double(frame) / fps_;
    if (trajectory_) trajectory_->add(v0::to_public(world.snapshot()));
    if (energy_) energy_->add(frame, time, v0::to_public(world.measure(), world.contact_records().energy));
    if (joints_) joints_->add(frame, time, v0::to_public(world.joint_states()));
    if (breaks_ && frame >= first_) breaks_->add(v0::to_public(world.breaks()));
    if (!needs_contacts()) return;
    v0::FrameContacts contacts = v0::to_public(world.contact_records());
    std::erase_if(contacts.impacts, [&](const v0::Impact& impact) { return impact.frame < first_; });
    if (impacts_) impacts_->add(contacts);
    if (contacts_ && frame % contacts_every_ == 0) contacts_->add(frame, time, contacts);
    if (loads_) loads_->add(frame, time, contacts);
}

void RunTables::finish() {
    if (trajectory_) trajectory_->finish();
    if (energy_) energy_->finish();
    if (impacts_) impacts_->finish();
    if (contacts_) contacts_->finish();
    if (loads_) loads_->finish();
    if (joints_) joints_->finish();
    if (breaks_) breaks_->finish();
}

}  // namespace tumble
