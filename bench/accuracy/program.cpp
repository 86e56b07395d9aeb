#include "accuracy/program.h"

#include "accuracy/measure.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string_view>

namespace tumble::bench {
namespace {

// A step is left out when it would take longer than this (CPU s), by what the step before it took.
constexpr double patience = 6.0;

struct Options {
    bool quick = false;
    std::vector<std::string> cases, variants;
    bool wants(const AccuracyCase& c) const {
        return cases.empty() || std::find(cases.begin(), cases.end(), c.name) != cases.end();
    }
    bool wants(const Variant& v) const {
        return variants.empty() || std::find(variants.begin(), variants.end(), v.name) != variants.end();
    }
};

std::string quoted(const std::string& text) { return text.find(',') == std::string::npos ? text : '"' + text + '"'; }

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
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view option = argv[i];
        if (option == "--quick") {
            options.quick = true;
        } else if (option == "--case" && i + 1 < argc) {
            options.cases.emplace_back(argv[++i]);
        } else if (option == "--variant" && i + 1 < argc) {
            options.variants.emplace_back(argv[++i]);
        } else if (option == "--header") {
            std::puts("case,program,variant,step,error,unit,cpu_seconds_per_simulated_second");
        } else if (option == "--list") {
            for (const AccuracyCase& c : cases) std::puts(c.name.c_str());
            return 0;
        } else {
            std::fprintf(stderr, "usage: %s [--header] [--quick] [--case NAME]... [--variant NAME]... | --list\n",
                         argv[0]);
            return 2;
        }
    }
    for (const AccuracyCase& c : cases) {
        if (!options.wants(c)) continue;
        for (const Variant& variant : variants) {
            if (!variant.meets(c.demand) || !options.wants(variant)) continue;
            try {
                climb(c, program, variant, options.quick);
            } catch (const std::exception& e) {  // a world that blew up: its row is missing, the others go on
                std::fprintf(stderr, "%s, %s, %s: %s\n", c.name.c_str(), program.c_str(), variant.name.c_str(),
                             e.what());
            }
        }
    }
    return 0;
}

}  // namespace tumble::bench
