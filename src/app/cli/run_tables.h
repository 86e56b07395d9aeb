// The tables of a run of `tumble simulate`, a row or some rows for each frame.
#pragma once

#include "app/cli/commands.h"
#include "sim/world.h"
#include "tumble/output.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace tumble {

class OutputPlan;

class RunTables {
public:
    /// Those that the command asks for. Throws RunError if a file cannot be made.
    /// `first`: of the frames that are added; impacts before it are left out.
    RunTables(const SimulateCommand& command, const v0::Scene& scene, std::int64_t first = 0);

    static void plan(const SimulateCommand& command, OutputPlan& plan);
    static std::vector<std::filesystem::path> files(const SimulateCommand& command);
    /// True if the world has to record contacts.
    bool needs_records() const { return energy_ || impacts_ || contacts_ || loads_; }

    /// Frames are given in order.
    void add(std::int64_t frame, const World& world);
    void finish();

private:
    double fps_;
    std::int64_t first_;
    std::optional<v0::TrajectoryTable> trajectory_;
    std::optional<v0::EnergyTable> energy_;
    std::optional<v0::ImpactTable> impacts_;
    std::optional<v0::ContactTable> contacts_;
    std::optional<v0::LoadTable> loads_;
    std::optional<v0::JointTable> joints_;
};

}  // namespace tumble
