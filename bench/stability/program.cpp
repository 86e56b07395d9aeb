#include "stability/program.h"

#include "harness/clock.h"
#include "harness/options.h"
#include "harness/penetration.h"
#include "stability/random_scenes.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>

namespace tumble::bench {
namespace {

constexpr double patience = 5.0;  // CPU s per cell
constexpr long random_scenes = 2000, quick_random_scenes = 84;
constexpr const char* random_name = "random scenes";

// late: stopped by patience; none: the program cannot represent the scene.
enum class Verdict { pass, fail, late, none };
constexpr const char* verdict_names[] = {"pass", "fail", "late", "none"};

struct Outcome {
    double worst = 0.0;
    Verdict verdict = Verdict::pass;
    long steps = 0;
};

Outcome run(const Trial& trial, const StabilityWay& way, double rate) {
    if (trial.scene.bodies.size() > way.most_bodies) return {0.0, Verdict::none, 0};
    if (trial.scene.has_water_or_breakage() && !way.water_and_breakage) return {0.0, Verdict::none, 0};
    const auto world = way.make(trial.scene, rate);
    if (!world) return {0.0, Verdict::none, 0};
    Outcome outcome;
    const long steps = std::lround(trial.seconds * rate);
    std::vector<Motion> motions(trial.scene.bodies.size());
    const double start = cpu_seconds();
    for (long i = 1; i <= steps; ++i) {
        world->step();
        if (i % trial.look_every != 0 && i != steps) continue;
        bool sane = true;
        for (std::size_t b = 0; b < motions.size(); ++b) {
            if (!trial.scene.bodies[b].moves()) continue;
            motions[b] = world->motion(b);
            sane = sane && finite(motions[b]);
        }
        double now = sane ? trial.watch(double(i) / rate, motions) : HUGE_VAL;
        if (trial.watch_totals && sane) now = std::max(now, trial.watch_totals(double(i) / rate, *world->totals()));
        outcome.worst = std::isnan(now) ? HUGE_VAL : std::max(outcome.worst, now);
        outcome.steps = i;
        if (outcome.worst > 1.0) {
            outcome.verdict = Verdict::fail;
            return outcome;
        }
        if (cpu_seconds() - start > patience && i < steps) {
            outcome.verdict = Verdict::late;
            return outcome;
        }
    }
    return outcome;
}

// In a process of its own: some worlds end the program when they diverge (assertions in DART).
Outcome run_apart(const Trial& trial, const StabilityWay& way, double rate) {
    const Outcome blown_up{HUGE_VAL, Verdict::fail, 0};
    int ends[2];
    if (pipe(ends) != 0) return run(trial, way, rate);
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        Outcome outcome = blown_up;
        try {
            const Outcome found = run(trial, way, rate);
            outcome = found;
        } catch (const std::exception& e) {
            std::fprintf(stderr, "%s at 1/%g: %s\n", way.name.c_str(), rate, e.what());
        }
        const bool written = write(ends[1], &outcome, sizeof outcome) == ssize_t(sizeof outcome);
        _exit(written ? 0 : 1);
    }
    ::close(ends[1]);
    Outcome outcome;
    if (child < 0 || read(ends[0], &outcome, sizeof outcome) != ssize_t(sizeof outcome)) outcome = blown_up;
    ::close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    return outcome;
}

void write_row(const StabilityCase& c, const std::string& program, const StabilityWay& way, double rate,
               double parameter, const Outcome& o) {
    std::printf("%s,%s,\"%s\",\"%s\",\"%s\",%g,%g,%.3g,%s,%ld\n", c.name.c_str(), program.c_str(), way.name.c_str(),
                c.parameter.c_str(), c.pass_line.c_str(), rate, parameter, o.worst, verdict_names[int(o.verdict)],
                o.steps);
    std::fflush(stdout);
}

void map(const StabilityCase& c, const std::string& program, const StabilityWay& way, bool quick) {
    std::vector<double> rates = c.rates, parameters = c.parameters;
    if (quick) {
        rates = {rates[1]};
        parameters = {parameters.front(), parameters[parameters.size() / 2]};
    }
    for (const double parameter : parameters)
        for (const double rate : rates) {
            Trial trial = c.trial(parameter, rate);
            if (quick) trial.seconds = std::min(trial.seconds, 1.0);
            write_row(c, program, way, rate, parameter, run_apart(trial, way, rate));
        }
}

// Seeds are distributed over the steps: scene i runs at the step i / 4 % 7, so that each step has all four kinds.
void map_random(const std::string& program, const StabilityWay& way, bool quick) {
    const std::vector<double> rates = stability_rates();
    const long each = long(rates.size()) * 4, all = quick ? quick_random_scenes : random_scenes;
    for (std::size_t k = 0; k < rates.size(); ++k) {
        std::vector<Count> sum;
        for (long kin = 0; kin < 4; ++kin) {
            const std::vector<Count> counts = run_random_scenes(way, rates[k], long(k) * 4 + kin, each, all);
            if (sum.empty())
                sum = counts;
            else
                for (std::size_t i = 0; i < sum.size(); ++i)
                    for (std::size_t n = 0; n < 4; ++n) {
                        sum[i].failed[n] += counts[i].failed[n];
                        sum[i].scenes[n] += counts[i].scenes[n];
                    }
        }
        for (const Count& c : sum)
            for (std::size_t kin = 0; kin < 4; ++kin)
                if (c.scenes[kin] > 0)
                    std::printf("random: %s,%s,\"%s\",\"%s of %ld\",\"%s\",%g,%ld,%ld,%s,%ld\n", c.invariant.c_str(),
                                program.c_str(), way.name.c_str(), kin_names[kin], c.scenes[kin], c.pass_line.c_str(),
                                rates[k], long(kin), c.failed[kin], c.failed[kin] == 0 ? "pass" : "fail",
                                std::lround(1.5 * rates[k]));
        std::fflush(stdout);
    }
}

}  // namespace

int run_stability(int argc, char** argv, const std::string& program, const std::vector<StabilityWay>& ways) {
    const std::vector<StabilityCase> cases = stability_cases();
    CommandLine line{"case,program,way,parameter,pass line,rate,value,worst,verdict,steps", {}, "way"};
    for (const StabilityCase& c : cases) line.cases.push_back(c.name);
    line.cases.push_back(random_name);
    Options options;
    if (const auto status = read_options(argc, argv, line, options)) return *status;
    for (const StabilityCase& c : cases)
        if (options.wants_case(c.name))
            for (const StabilityWay& way : ways)
                if (options.wants_way(way.name) && (c.flight || way.contacts)) map(c, program, way, options.quick);
    if (options.wants_case(random_name))
        for (const StabilityWay& way : ways)
            if (options.wants_way(way.name) && way.contacts) map_random(program, way, options.quick);
    return 0;
}

}  // namespace tumble::bench
