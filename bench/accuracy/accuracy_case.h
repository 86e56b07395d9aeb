// A case of the benchmark: a scene, its steps, and the definition of its error.
#pragma once

#include "accuracy/simulator.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble::bench {

struct Error {
    std::string quantity;  // "energy", "orientation", ...
    double value = 0.0;
    std::string unit;
};

/// Observes the bodies before every step (step = 0, 1, ...) and after the last, and computes the errors.
class Observer {
public:
    virtual ~Observer() = default;
    virtual void see(long step, double rate, const std::vector<Motion>& motions) = 0;
    virtual std::vector<Error> errors() const = 0;
};

struct AccuracyCase {
    std::string name;
    Demand demand = Demand::impact;
    Scene scene;
    double seconds = 10.0;       // simulated
    std::vector<double> rates;   // steps per second
    double quick_seconds = 2.0;  // in the smoke test
    std::vector<double> quick_rates{30.0, 240.0};
    std::function<std::unique_ptr<Observer>(const Scene&, double seconds)> observe;
    /// For step-free variants: errors that a grid of steps cannot resolve.
    std::function<std::vector<Error>(const Scene&, const Variant&)> probe;
};

std::vector<AccuracyCase> accuracy_cases();

// The parts of accuracy_cases(), one file each.
void add_flights(std::vector<AccuracyCase>& cases);  // torque-free, and under drag and a push
void add_bounces(
    std::vector<AccuracyCase>& cases);  // sphere, flat box, tilted box; a ball that comes to rest; thin walls
void add_crowds(std::vector<AccuracyCase>& cases);  // SimBenchmark's bouncing and elastic 666, the pit
void add_rows(std::vector<AccuracyCase>& cases);    // cradles, Bernoulli's three balls

/// The steps: 1/30 ... 1/1920 s.
std::vector<double> ladder(double finest = 1920.0);

}  // namespace tumble::bench
