#include "accuracy/program.h"

#include "accuracy/measure.h"
#include "harness/options.h"

#include <algorithm>
#include <cstdio>
#include <exception>

namespace tumble::bench {
namespace {

// A step is skipped if, by the time of the last step, it would take longer than this (CPU s).
constexpr double patience = 6.0;

void write_rows(const AccuracyCase& c, const std::string& program, const Variant& variant, double rate,
                const Measured& m) {
    for (const Error& e : m.errors) {
        const std::string name = c.name + ": " + e.quantity;
        std::printf("%s,%s,%s,%.10g,%.6g,%s,%.4g\n", quoted(name).c_str(), program.c_str(),
                    quoted(variant.name).c_str(), 1.0 / rate, std::isfinite(e.value) ? e.value : HUGE_VAL,
                    e.unit.c_str(), m.cpu);
    }
    std::fflush(stdout);
}

void climb(const AccuracyCase& c, const std::string& program, const Variant& variant, bool quick) {
    const double seconds = quick ? c.quick_seconds : c.seconds;
    double spent = 0.0, last_rate = 0.0;
    for (const double rate : quick ? c.quick_rates : c.rates) {
        if (!quick && spent * rate / std::max(last_rate, 1.0) > patience) break;
        const Measured m = measure(c, variant, rate, seconds, !quick);
        if (m.errors.empty()) return;
        write_rows(c, program, variant, rate, m);
        spent = m.spent;
        last_rate = rate;
    }
}

}  // namespace

int run_accuracy(int argc, char** argv, const std::string& program, const std::vector<Variant>& variants) {
    const std::vector<AccuracyCase> cases = accuracy_cases();
    CommandLine line{"case,program,variant,step,error,unit,cpu_seconds_per_simulated_second", {}, "variant"};
    for (const AccuracyCase& c : cases) line.cases.push_back(c.name);
    Options options;
    if (const auto status = read_options(argc, argv, line, options)) return *status;
    for (const AccuracyCase& c : cases) {
        if (!options.wants_case(c.name)) continue;
        for (const Variant& variant : variants) {
            if (!variant.meets(c.demand) || !options.wants_way(variant.name)) continue;
            try {
                climb(c, program, variant, options.quick);
            } catch (const std::exception& e) {  // a world that diverged: its row is missing, the others go on
                std::fprintf(stderr, "%s, %s, %s: %s\n", c.name.c_str(), program.c_str(), variant.name.c_str(),
                             e.what());
            }
        }
    }
    return 0;
}

}  // namespace tumble::bench
