#include "accuracy/measure.h"

#include "harness/clock.h"

#include <algorithm>

namespace tumble::bench {
namespace {

constexpr double long_enough = 0.15;  // CPU s; makes the clock's own cost and resolution negligible
constexpr int fewest_runs = 3, most_runs = 2000;

// The median over fresh worlds of the total time of all steps.
double time_of_stepping(const AccuracyCase& c, const Variant& variant, double rate, long steps) {
    std::vector<double> runs;
    double sum = 0.0;
    while (int(runs.size()) < fewest_runs || (sum < long_enough && int(runs.size()) < most_runs)) {
        const auto world = variant.make(c.scene, rate);
        const double start = cpu_seconds();
        for (long i = 0; i < steps; ++i) world->step();
        runs.push_back(cpu_seconds() - start);
        sum += runs.back();
    }
    std::nth_element(runs.begin(), runs.begin() + runs.size() / 2, runs.end());
    return runs[runs.size() / 2];
}

}  // namespace

Measured measure(const AccuracyCase& c, const Variant& variant, double rate, double seconds, bool timed) {
    const auto world = variant.make(c.scene, rate);
    Measured result;
    if (!world) return result;
    const double begin = cpu_seconds();
    const auto observer = c.observe(c.scene, seconds);
    const long steps = std::lround(seconds * rate);
    std::vector<Motion> motions(c.scene.bodies.size());
    double stepping = 0.0;
    for (long i = 0;; ++i) {
        for (std::size_t b = 0; b < motions.size(); ++b)
            if (c.scene.bodies[b].moves()) motions[b] = world->motion(b);
        observer->see(i, rate, motions);
        if (i == steps) break;
        const double start = cpu_seconds();
        world->step();
        stepping += cpu_seconds() - start;
    }
    result.errors = observer->errors();
    if (c.probe && variant.step_free) {
        for (const Error& better : c.probe(c.scene, variant))
            for (Error& e : result.errors)
                if (e.quantity == better.quantity) e = better;
    }
    result.spent = cpu_seconds() - begin;
    if (timed && stepping < 2.0 * long_enough) stepping = time_of_stepping(c, variant, rate, steps);
    result.cpu = stepping / seconds;
    return result;
}

}  // namespace tumble::bench
