// Tumble in the joints benchmark.
#include "joints/program.h"
#include "tumble/tumble_simulator.h"

namespace {

using namespace tumble::bench;

JointWay way(const std::string& name, const std::vector<JointTask>& tasks, const TumbleSettings& settings) {
    return {name, tasks, [=](const Scene& scene, double rate) { return make_tumble(scene, rate, settings); }};
}

}  // namespace

int main(int argc, char** argv) {
    using enum JointTask;
    TumbleSettings one, two, asleep, splitting, exact, sweeps;
    two.threads = 2;
    asleep.sleep = true;
    splitting.integrator = tumble::IntegratorKind::splitting;
    exact.integrator = tumble::IntegratorKind::exact;
    sweeps.contact_solver = tumble::ContactSolverChoice::soft;
    return run_joints(argc, argv, "Tumble",
                      {way("default", {precision, load, speed, settling}, one), way("two threads", {settling}, two),
                       way("sleep", {settling}, asleep), way("sweeps", {settling}, sweeps),
                       way("splitting", {precision}, splitting), way("exact", {precision}, exact)});
}
