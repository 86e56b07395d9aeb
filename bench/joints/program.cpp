#include "joints/program.h"

#include "harness/clock.h"
#include "harness/options.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>

namespace tumble::bench {
namespace {

constexpr double long_enough = 0.1;      // CPU s of stepping, which makes the clock's own cost negligible
constexpr int most_repetitions = 500;    // of a short run
constexpr double joints_patience = 6.0;  // CPU s, unless --patience is given
// Where a peer does not end a step, or the construction of its world: its process is ended after so many times the
// patience, in wall time. A limit of the CPU time would make the system count it in ticks of milliseconds.
constexpr double most_wall = 60.0;

struct Spending {
    double cpu = 0.0, wall = 0.0;
    long steps = 0;
};

class Measurement {
public:
    Measurement(const JointCase& c, const JointWay& way, double rate, const Options& options)
        : case_(c),
          way_(way),
          rate_(rate),
          seconds_(options.quick && c.quick_seconds > 0.0 ? c.quick_seconds : c.seconds),
          steps_(std::max(1L, std::lround(seconds_ * rate))),
          patience_(patience_of(c, options)) {}

    static double patience_of(const JointCase& c, const Options& options) {
        return c.task == JointTask::settling ? 5.0 * options.patience : options.patience;
    }

    /// The quantities; empty where the program cannot represent the scene.
    std::vector<Quantity> take(bool timed) {
        const auto watch = case_.watch(case_.scene, seconds_);
        Spending run;
        if (!watched_run(*watch, run)) return {};
        cut_ = run.steps < steps_;
        if (timed && !cut_ && case_.task == JointTask::precision && run.cpu < long_enough) repeat(run);
        const double simulated = double(run.steps) / rate_;
        std::vector<Quantity> all{{"CPU", run.cpu / simulated, "s/s"}, {"wall", run.wall / simulated, "s/s"}};
        if (case_.links > 0) {
            const double share = 1e9 / (double(case_.links) * double(run.steps));
            all.push_back({"CPU a link and step", share * run.cpu, "ns"});
        }
        if (cut_) all.push_back({"cut short at", simulated, "s"});
        for (const Quantity& q : watch->tell())
            if (!cut_ || q.name != "error") all.push_back(q);
        return all;
    }
    bool cut() const { return cut_; }

private:
    bool watched_run(Watch& watch, Spending& run) {
        const auto world = way_.make(case_.scene, rate_);
        if (!world) return false;
        const long look = case_.look_every > 0.0 ? std::max(1L, std::lround(case_.look_every * rate_)) : 1;
        std::vector<Motion> motions(case_.scene.bodies.size());
        for (;;) {
            for (std::size_t b = 0; b < motions.size(); ++b)
                if (case_.scene.bodies[b].moves()) motions[b] = world->motion(b);
            watch.see(double(run.steps) / rate_, *world, motions);
            if (run.steps >= steps_ || run.cpu > patience_) return true;
            advance(*world, std::min(look, steps_ - run.steps), run);
        }
    }

    void advance(Simulator& world, long steps, Spending& run) const {
        const double cpu = cpu_seconds(), wall = wall_seconds();
        long done = 0;
        while (done < steps && (done == 0 || run.cpu + cpu_seconds() - cpu < patience_)) {
            world.step();
            ++done;
        }
        run.cpu += cpu_seconds() - cpu;
        run.wall += wall_seconds() - wall;
        run.steps += done;
    }

    // The median over fresh worlds of the time of all steps.
    void repeat(Spending& run) const {
        std::vector<double> times;
        double sum = 0.0;
        while (int(times.size()) < 3 || (sum < long_enough && int(times.size()) < most_repetitions)) {
            const auto world = way_.make(case_.scene, rate_);
            const double start = cpu_seconds();
            for (long i = 0; i < steps_; ++i) world->step();
            times.push_back(cpu_seconds() - start);
            sum += times.back();
        }
        std::nth_element(times.begin(), times.begin() + long(times.size() / 2), times.end());
        run.wall *= times[times.size() / 2] / run.cpu;
        run.cpu = times[times.size() / 2];
    }

    const JointCase& case_;
    const JointWay& way_;
    double rate_, seconds_;
    long steps_;
    double patience_;
    bool cut_ = false;
};

void write_figures(const std::string& name, const std::string& program, const JointWay& way, double rate,
                   const std::vector<Quantity>& all) {
    for (const Quantity& q : all)
        std::printf("%s,%s,%s,%.10g,%s,%.6g,%s\n", quoted(name).c_str(), program.c_str(), quoted(way.name).c_str(),
                    1.0 / rate, quoted(q.name).c_str(), std::isfinite(q.value) ? q.value : HUGE_VAL, q.unit.c_str());
    std::fflush(stdout);
}

enum class Ending { done, cut, absent, failed, stuck };

// The system ends this process by a signal after that.
void limit_process(double patience) { alarm(unsigned(std::ceil(most_wall * patience))); }

// One step of one way, in a process of its own: a peer may end it by a failed assertion. `spent`: CPU s.
Ending measure_apart(const JointCase& c, const std::string& program, const JointWay& way, double rate,
                     const Options& options, double& spent) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) {
        limit_process(Measurement::patience_of(c, options));
        Ending ending = Ending::failed;
        try {
            Measurement measurement(c, way, rate, options);
            const std::vector<Quantity> all = measurement.take(!options.quick);
            write_figures(c.name, program, way, rate, all);
            ending = all.empty() ? Ending::absent : measurement.cut() ? Ending::cut : Ending::done;
        } catch (const std::exception& e) {  // a world that diverged
            std::fprintf(stderr, "%s, %s, %s, 1/%g s: %s\n", c.name.c_str(), program.c_str(), way.name.c_str(), rate,
                         e.what());
        }
        std::fflush(stdout);
        _exit(int(ending));
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    spent = double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) {
        std::fprintf(stderr, "%s, %s, %s, 1/%g s: took more than %g times the patience, and was ended\n",
                     c.name.c_str(), program.c_str(), way.name.c_str(), rate, most_wall);
        return Ending::stuck;
    }
    return WIFEXITED(status) ? Ending(WEXITSTATUS(status)) : Ending::failed;
}

// From coarse to fine.
void climb_rates(const JointCase& c, const std::string& program, const JointWay& way, const Options& options) {
    double spent = 0.0, last_rate = 0.0;
    for (const double rate : options.quick ? c.quick_rates : c.rates) {
        const bool slow = last_rate > 0.0 && spent * rate / last_rate > options.patience;
        if (slow && c.task == JointTask::precision) return;  // it would be cut short, without an error
        const Ending ending = measure_apart(c, program, way, rate, options, spent);
        if (ending == Ending::absent || ending == Ending::cut) return;
        if (ending == Ending::failed || ending == Ending::stuck)
            write_figures(c.name, program, way, rate, {{"ended by an error", 1.0, ""}});
        if (ending == Ending::stuck) return;
        last_rate = ending == Ending::done ? rate : 0.0;
    }
}

}  // namespace

int run_joints(int argc, char** argv, const std::string& program, const std::vector<JointWay>& ways) {
    const std::vector<JointCase> cases = joint_cases();
    CommandLine line{"case,program,way,step,quantity,value,unit", {}, "way", true};
    for (const JointCase& c : cases) line.cases.push_back(c.name);
    Options options;
    options.patience = joints_patience;
    if (const auto status = read_options(argc, argv, line, options)) return *status;
    for (const JointCase& c : cases) {
        if (!options.wants_case(c.name)) continue;
        for (const JointWay& way : ways) {
            if (!options.wants_way(way.name) || c.scene.bodies.size() > way.most_bodies) continue;
            if (std::find(way.tasks.begin(), way.tasks.end(), c.task) == way.tasks.end()) continue;
            climb_rates(c, program, way, options);
        }
    }
    return 0;
}

}  // namespace tumble::bench
