// A case of the stability map: a family of scenes over (step, parameter), and a pass line fixed in advance.
#pragma once

#include "harness/simulator.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble::bench {

/// One cell of a map: the scene to run and its observation.
struct Trial {
    Scene scene;
    double seconds = 5.0;
    long look_every = 1;  // in steps
    /// Present error, with 1 as the pass line; the largest of all observations counts. The run ends where it exceeds 1.
    std::function<double(double time, const std::vector<Motion>& motions)> watch;
    /// The same of the sums over all bodies; empty where nothing breaks.
    std::function<double(double time, const Totals& totals)> watch_totals = nullptr;
};

struct StabilityCase {
    std::string name;
    std::string parameter;  // with its unit
    std::string pass_line;  // in words, for the table
    std::vector<double> parameters;
    std::vector<double> rates;  // steps per second
    std::function<Trial(double parameter, double rate)> trial;
    bool flight = false;  // bodies move freely most of the time: every integrator has its own map
};

std::vector<StabilityCase> stability_cases();

// The parts of stability_cases(), one file each.
void add_loads(std::vector<StabilityCase>& cases);   // stacks, mass ratios, scales, far from the origin, 600 s of rest
void add_spins(std::vector<StabilityCase>& cases);   // spins, inertia ratios, a million steps of tumbling
void add_joints(std::vector<StabilityCase>& cases);  // chains under load, motors, limits, breaking
void add_water(std::vector<StabilityCase>& cases);   // density ratios in still water, waves
void add_breaking(std::vector<StabilityCase>& cases);  // cells and strengths of a plate
void add_strikes(std::vector<StabilityCase>& cases);   // thin walls, restitution, friction, deep overlap, needles

/// 1/30 ... 1/1920 s.
std::vector<double> stability_rates();

}  // namespace tumble::bench
