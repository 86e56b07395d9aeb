// Makes the samples of a plan in worker processes, each on one core, and writes the manifest.
#pragma once

#include "app/sweep/sweep_sample.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tumble {

struct SweepOptions {
    std::filesystem::path folder;
    int workers = 1;
    bool stop_at_first = false;      // failure
    std::vector<std::int64_t> only;  // samples to make again; empty: all that are not there
};

struct SweepCounts {
    std::int64_t made = 0, kept = 0, failed = 0;
    std::int64_t done() const { return made + kept + failed; }
};

/// Called in the program's thread.
struct SweepReports {
    std::function<void(const SweepSample&, const std::string& reason)> failure;
    std::function<void(std::int64_t done)> progress;
};

/// Checks that the first samples are not all wrong, and that the programs for the outputs are there. Writes nothing.
/// Throws InputError or RunError. Returns the number of workers that fit into memory.
int check_sweep(const SweepPlan& plan, const std::string& scene, int workers);

/// Throws RunError after an interrupt, at the first failure if asked for, and if the folder cannot be written to;
/// samples that were made stay. Precondition: check_sweep(), and the program has no other thread.
SweepCounts run_sweep(const SweepPlan& plan, const std::string& scene, const SweepOptions& options,
                      const SweepReports& reports);

}  // namespace tumble
