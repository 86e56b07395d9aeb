// The tables of a run, a row or some rows for each frame: of `tumble simulate`, and of the samples of sweeps.
#pragma once

#include "sim/world.h"
#include "tumble/output.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace tumble {

class OutputPlan;

/// The files of the tables that are asked for.
struct TableFiles {
    std::optional<std::filesystem::path> trajectory, energy, impacts, contacts, loads, joints, breaks;
    std::int64_t contacts_every = 1;  // frames between two with rows of contacts; frame 0 has some

    std::vector<std::filesystem::path> all() const;
    /// As the values of the options of `tumble simulate`.
    void add_to(OutputPlan& plan) const;
};

class RunTables {
public:
    /// Throws RunError if a file cannot be made.
    /// `first`: of the frames that are added; impacts before it are left out.
    RunTables(const TableFiles& files, const v0::Scene& scene, std::int64_t first = 0);

    /// True if the world has to record contacts, or the energy ledger.
    bool needs_records() const { return energy_ || needs_contacts(); }
    /// Makes the world record as much as the tables need.
    void start_records(World& world) const;

    /// Frames are given in order.
    void add(std::int64_t frame, const World& world);
    void finish();

private:
    bool needs_contacts() const { return impacts_ || contacts_ || loads_; }

    double fps_;
    std::int64_t first_, contacts_every_;
    std::optional<v0::TrajectoryTable> trajectory_;
    std::optional<v0::EnergyTable> energy_;
    std::optional<v0::ImpactTable> impacts_;
    std::optional<v0::ContactTable> contacts_;
    std::optional<v0::LoadTable> loads_;
    std::optional<v0::JointTable> joints_;
    std::optional<v0::BreakTable> breaks_;
};

}  // namespace tumble
