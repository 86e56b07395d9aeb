#include "contact/program.h"

#include "harness/clock.h"
#include "harness/options.h"

#include <algorithm>
#include <cstdio>
#include <exception>

namespace tumble::bench {
namespace {

// Time of stepping alone, as a whole and of the last 2 s.
struct Spent {
    double cpu = 0.0, wall = 0.0, late_cpu = 0.0, simulated = 0.0, late_simulated = 0.0;
    void add(double more_cpu, double more_wall, double seconds, bool late) {
        cpu += more_cpu;
        wall += more_wall;
        simulated += seconds;
        if (!late) return;
        late_cpu += more_cpu;
        late_simulated += seconds;
    }
};

std::vector<Quantity> run(const ContactCase& c, const Way& way, const Options& options) {
    const auto world = way.make(c.scene, c.rate);
    if (!world) return {};
    const auto witness = c.witness(c.scene);
    const double seconds = options.quick ? c.quick_seconds : c.seconds, late_from = seconds - 2.0 - 1e-9;
    const long steps = std::lround(seconds * c.rate), look = std::max(1L, std::lround(c.look_every * c.rate));
    const long burst = std::min(look, std::max(1L, std::lround(0.5 * c.rate)));  // steps between readings of the clocks
    std::vector<Motion> motions(c.scene.bodies.size());
    Spent spent;
    long done = 0;
    bool patient = true;
    for (;;) {
        patient = spent.cpu < options.patience;
        if (done % look == 0 || done == steps || !patient) {
            for (std::size_t b = 0; b < motions.size(); ++b)
                if (c.scene.bodies[b].moves()) motions[b] = world->motion(b);
            witness->see(double(done) / c.rate, motions);
        }
        if (done == steps || !patient) break;
        const bool late = double(done) / c.rate >= late_from;
        const long next = std::min({steps, done + burst, (done / look + 1) * look});
        const double cpu = cpu_seconds(), wall = wall_seconds();
        for (long i = done; i < next; ++i) world->step();
        spent.add(cpu_seconds() - cpu, wall_seconds() - wall, double(next - done) / c.rate, late);
        done = next;
    }
    std::vector<Quantity> all{{"CPU", spent.cpu / spent.simulated, "s/s"},
                              {"wall", spent.wall / spent.simulated, "s/s"}};
    if (spent.late_simulated > 0.0)
        all.push_back({"CPU of the last 2 s", spent.late_cpu / spent.late_simulated, "s/s"});
    if (done < steps) all.push_back({"cut short at", double(done) / c.rate, "s"});
    for (const Quantity& q : witness->tell()) all.push_back(q);
    return all;
}

void write(const std::string& name, const std::string& program, const Way& way, const std::vector<Quantity>& all) {
    for (const Quantity& q : all)
        std::printf("%s,%s,%s,%s,%.6g,%s\n", quoted(name).c_str(), program.c_str(), quoted(way.name).c_str(),
                    quoted(q.name).c_str(), std::isfinite(q.value) ? q.value : HUGE_VAL, q.unit.c_str());
    std::fflush(stdout);
}

}  // namespace

int run_contact(int argc, char** argv, const std::string& program, const std::vector<Way>& ways) {
    const std::vector<ContactCase> cases = contact_cases();
    CommandLine line{"case,program,way,quantity,value,unit", {}, "way", true};
    for (const ContactCase& c : cases) line.cases.push_back(c.name);
    Options options;
    if (const auto status = read_options(argc, argv, line, options)) return *status;
    for (const ContactCase& c : cases) {
        if (!options.wants_case(c.name)) continue;
        for (const Way& way : ways) {
            if (!options.wants_way(way.name) || c.scene.bodies.size() > way.most_bodies) continue;
            if (std::find(way.tasks.begin(), way.tasks.end(), c.task) == way.tasks.end()) continue;
            try {
                write(c.name, program, way, run(c, way, options));
            } catch (const std::exception& e) {  // a world that diverged
                std::fprintf(stderr, "%s, %s, %s: %s\n", c.name.c_str(), program.c_str(), way.name.c_str(), e.what());
                write(c.name, program, way, {{"ended by an error", 1.0, ""}});
            }
        }
    }
    return 0;
}

}  // namespace tumble::bench
