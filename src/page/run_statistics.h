// Sums over a recorded run: its energy balance and its contacts.
#pragma once

#include "page/page_run.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble {

/// J; `start` and `end` are rows of the energy table.
struct EnergyBalance {
    EnergySample start, end;
    double largest_residual = 0.0;  // of |total + losses - work - the same at the start|
    double residual_time = 0.0;     // s, of the largest residual
    double scale = 0.0;             // largest change of the kinetic, the potential or the elastic energy, or of a loss
};
double total_energy(const EnergySample& energy);
/// Total energy and losses without work: constant but for errors.
double balance_of(const EnergySample& energy);
EnergyBalance energy_balance(const PageRun& run);

struct ContactStatistics {
    std::int64_t count = 0;                     // contact points of all frames
    std::int64_t kept = 0;                      // of the record, which the next two count
    std::array<std::int64_t, 4> by_state{};     // rows of the contact table, by ContactRecord::State
    std::array<std::int64_t, 6> by_features{};  // the same, by ContactFeatures
    std::int64_t most = 0;                      // touching points of a frame
    double deepest = 0.0;                       // m, largest overlap of a frame
    double deepest_time = 0.0;                  // s
    double largest_force = 0.0;                 // N, normal force of a contact point
};
ContactStatistics contact_statistics(const PageRun& run);

struct ImpactStatistics {
    std::int64_t count = 0;                     // impulses at contact points
    std::int64_t kept = 0;                      // of the record, the strongest, which the next counts
    std::array<std::int64_t, 6> by_features{};  // by ContactFeatures
    double largest_impulse = 0.0;               // N s
    double largest_time = 0.0;                  // s, of that impact
    std::size_t a = 0, b = 0;                   // its bodies
    double fastest = 0.0;                       // m/s, largest approach speed
};
ImpactStatistics impact_statistics(const PageRun& run);

}  // namespace tumble
