// A case of the contact benchmark: a scene at one step, the interval of observation, and the reported quantities.
#pragma once

#include "harness/quantity.h"
#include "harness/simulator.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble::bench {

/// Observes the bodies at the start, at intervals, and at the end.
class Witness {
public:
    virtual ~Witness() = default;
    virtual void see(double time, const std::vector<Motion>& motions) = 0;
    virtual std::vector<Quantity> tell() const = 0;
};

/// pile: speed, by all ways of a program (threads, sleep). settled: sleeping bodies beside bodies that are kept awake.
/// sleeping: only ways that sleep. The others: the program's best way.
enum class Task { pile, settled, sleeping, spheres, tower };

struct ContactCase {
    std::string name;
    Task task = Task::tower;
    Scene scene;
    double rate = 60.0;     // steps per second
    double seconds = 10.0;  // simulated
    double quick_seconds = 0.5;
    double look_every = 0.1;  // s
    std::function<std::unique_ptr<Witness>(const Scene&)> witness;
};

std::vector<ContactCase> contact_cases();

// The parts of contact_cases(), one file each.
void add_piles(std::vector<ContactCase>& cases);    // piles of 1000 and 8000, sleepers, energy in a pit
void add_spheres(std::vector<ContactCase>& cases);  // 216 spheres at rest, SimBenchmark 666
void add_towers(std::vector<ContactCase>& cases);   // stacks, mass ratios, pyramid, arch, card house
void add_slides(std::vector<ContactCase>& cases);   // inclines, SimBenchmark rolling, 600 s of rest

}  // namespace tumble::bench
