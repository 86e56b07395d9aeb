// Tumble in the stability benchmark.
#include "stability/program.h"
#include "tumble/tumble_simulator.h"

int main(int argc, char** argv) {
    using namespace tumble;
    const auto way = [](const std::string& name, bool contacts, IntegratorKind integrator, ImpactMode impacts) {
        const auto make = [=](const bench::Scene& scene, double rate) {
            return bench::make_tumble(scene, rate, {integrator, impacts});
        };
        return bench::StabilityWay{.name = name, .contacts = contacts, .make = make, .water_and_breakage = true};
    };
    return bench::run_stability(argc, argv, "Tumble",
                                {way("symplectic-euler", true, IntegratorKind::symplectic_euler, ImpactMode::stepped),
                                 way("exact + exact impacts", true, IntegratorKind::exact, ImpactMode::exact),
                                 way("explicit-euler", false, IntegratorKind::explicit_euler, ImpactMode::stepped),
                                 way("splitting", false, IntegratorKind::splitting, ImpactMode::stepped),
                                 way("rk4", false, IntegratorKind::runge_kutta_4, ImpactMode::stepped),
                                 way("exact", false, IntegratorKind::exact, ImpactMode::stepped)});
}
