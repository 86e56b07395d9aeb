#include "contact/program.h"

#include "harness/clock.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

namespace tumble::bench {
namespace {

struct Options {
    bool quick = false;
    double patience = 150.0;  // CPU s
    std::vector<std::string> cases, ways;
};

bool wanted(const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

std::string quoted(const std::string& text) { return text.find(',') == std::string::npos ? text : '"' + text + '"'; }

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
    const long burst = std::min(look, std::max(1L, std::lround(0.5 * c.rate)));  // between looks at the clocks
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

// False where the command line is wrong.
bool read(int argc, char** argv, Options& options) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view option = argv[i];
        const bool more = i + 1 < argc;
        if (option == "--quick")
            options.quick = true;
        else if (option == "--case" && more)
            options.cases.emplace_back(argv[++i]);
        else if (option == "--way" && more)
            options.ways.emplace_back(argv[++i]);
        else if (option == "--patience" && more)
            options.patience = std::atof(argv[++i]);
        else if (option == "--header")
            std::puts("case,program,way,quantity,value,unit");
        else
            return false;
    }
    return true;
}

}  // namespace

int run_contact(int argc, char** argv, const std::string& program, const std::vector<Way>& ways) {
    const std::vector<ContactCase> cases = contact_cases();
    if (argc == 2 && std::string_view(argv[1]) == "--list") {
        for (const ContactCase& c : cases) std::puts(c.name.c_str());
        return 0;
    }
    Options options;
    if (!read(argc, argv, options)) {
        std::fprintf(stderr,
                     "usage: %s [--header] [--quick] [--case NAME]... [--way NAME]... [--patience SECONDS] | --list\n",
                     argv[0]);
        return 2;
    }
    for (const ContactCase& c : cases) {
        if (!wanted(options.cases, c.name)) continue;
        for (const Way& way : ways) {
            if (!wanted(options.ways, way.name) || c.scene.bodies.size() > way.most_bodies) continue;
            if (std::find(way.tasks.begin(), way.tasks.end(), c.task) == way.tasks.end()) continue;
            try {
                write(c.name, program, way, run(c, way, options));
            } catch (const std::exception& e) {  // a world that blew up
                std::fprintf(stderr, "%s, %s, %s: %s\n", c.name.c_str(), program.c_str(), way.name.c_str(), e.what());
                write(c.name, program, way, {{"ended by an error", 1.0, ""}});
            }
        }
    }
    return 0;
}

}  // namespace tumble::bench
