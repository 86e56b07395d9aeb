// Tumble in the contact benchmark. Default settings for all cases.
#include "contact/program.h"
#include "tumble/tumble_simulator.h"

namespace {

using namespace tumble::bench;

Way way(const std::string& name, const std::vector<Task>& tasks, const TumbleSettings& settings) {
    return {name, tasks, [=](const Scene& scene, double rate) { return make_tumble(scene, rate, settings); }};
}

}  // namespace

int main(int argc, char** argv) {
    TumbleSettings one, two, asleep, exact, soft, direct;
    two.threads = 2;
    asleep.sleep = true;
    soft.contact_solver = tumble::ContactSolverChoice::soft;
    direct.contact_solver = tumble::ContactSolverChoice::direct;
    exact.integrator = tumble::IntegratorKind::exact;
    exact.impacts = tumble::ImpactMode::exact;
    return run_contact(
        argc, argv, "Tumble",
        {way("default", {Task::pile, Task::settled, Task::spheres, Task::tower}, one),
         way("two threads", {Task::pile}, two), way("sleep", {Task::pile, Task::settled, Task::sleeping}, asleep),
         way("soft", {Task::pile, Task::spheres, Task::tower}, soft),
         way("direct", {Task::spheres, Task::tower}, direct), way("exact + exact impacts", {Task::tower}, exact)});
}
