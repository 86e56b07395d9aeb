#include "page/run_statistics.h"

#include <algorithm>
#include <cmath>

namespace tumble {

double total_energy(const EnergySample& energy) {
    return energy.kinetic_linear + energy.kinetic_angular + energy.potential + energy.elastic;
}

double balance_of(const EnergySample& energy) {
    return total_energy(energy) + energy.impact_loss + energy.friction_loss - energy.work;
}

EnergyBalance energy_balance(const PageRun& run) {
    EnergyBalance balance;
    if (run.energy.empty()) return balance;
    balance.start = run.energy.front();
    balance.end = run.energy.back();
    const double constant = balance_of(balance.start);
    for (std::size_t n = 0; n < run.energy.size(); ++n) {
        const EnergySample &now = run.energy[n], &start = balance.start;
        const double residual = std::abs(balance_of(now) - constant);
        if (residual > balance.largest_residual) {
            balance.largest_residual = residual;
            balance.residual_time = double(n) / run.scene.output.fps;
        }
        const double kinetic = now.kinetic_linear + now.kinetic_angular;
        balance.scale = std::max({balance.scale, std::abs(kinetic - start.kinetic_linear - start.kinetic_angular),
                                  std::abs(now.potential - start.potential), std::abs(now.elastic - start.elastic),
                                  std::abs(now.impact_loss), std::abs(now.friction_loss), std::abs(now.work)});
    }
    return balance;
}

ContactStatistics contact_statistics(const PageRun& run) {
    ContactStatistics statistics;
    statistics.count = run.all_contacts;
    for (const auto& frame : run.contacts)
        for (const ContactRecord& contact : frame) {
            ++statistics.kept;
            if (contact.a == ContactRecord::nobody) continue;  // a correction of the method
            ++statistics.by_state[std::size_t(contact.state)];
            ++statistics.by_features[std::size_t(contact.features)];
            statistics.largest_force = std::max(statistics.largest_force, contact.normal_force);
        }
    for (std::size_t n = 0; n < run.energy.size(); ++n) {
        const EnergySample& now = run.energy[n];
        statistics.most = std::max(statistics.most, std::int64_t(now.contacts));
        if (now.max_penetration > statistics.deepest) {
            statistics.deepest = now.max_penetration;
            statistics.deepest_time = double(n) / run.scene.output.fps;
        }
    }
    return statistics;
}

ImpactStatistics impact_statistics(const PageRun& run) {
    ImpactStatistics statistics;
    statistics.count = run.all_impacts;
    statistics.kept = std::int64_t(run.impacts.size());
    for (const PageImpact& one : run.impacts) {
        const ImpactRecord& impact = one.record;
        ++statistics.by_features[std::size_t(impact.features)];
        statistics.fastest = std::max(statistics.fastest, -impact.speed_before);
        if (impact.impulse > statistics.largest_impulse) {
            statistics.largest_impulse = impact.impulse;
            statistics.largest_time = impact.when.time;
            statistics.a = impact.a;
            statistics.b = impact.b;
        }
    }
    return statistics;
}

}  // namespace tumble
