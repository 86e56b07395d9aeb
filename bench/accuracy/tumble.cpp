// Tumble in the accuracy benchmark.
#include "accuracy/program.h"
#include "tumble/tumble_simulator.h"

namespace {

using namespace tumble;
using bench::Demand;

constexpr unsigned flights = 1u << int(Demand::flight), impacts = 1u << int(Demand::impact) | 1u << int(Demand::crowd);
constexpr unsigned walls = 1u << int(Demand::thin_wall);
constexpr unsigned handed_on = 1u << int(Demand::row_propagating), newton = 1u << int(Demand::row_simultaneous);

// Every integrator and impact mode of World, with its demands: one line each.
struct Way {
    const char* name;
    IntegratorKind integrator;
    ImpactMode mode;
    ImpactLaw law;
    unsigned demands;
};
constexpr Way ways[] = {
    {"explicit-euler", IntegratorKind::explicit_euler, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts},
    {"symplectic-euler", IntegratorKind::symplectic_euler, ImpactMode::stepped, ImpactLaw::propagating,
     flights | impacts | walls | handed_on},
    {"symplectic-euler, simultaneous", IntegratorKind::symplectic_euler, ImpactMode::stepped, ImpactLaw::simultaneous,
     newton},
    {"splitting", IntegratorKind::splitting, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts},
    {"rk4", IntegratorKind::runge_kutta_4, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts},
    {"exact", IntegratorKind::exact, ImpactMode::stepped, ImpactLaw::propagating, flights | impacts | walls},
    {"exact + exact impacts", IntegratorKind::exact, ImpactMode::exact, ImpactLaw::propagating,
     flights | impacts | walls | handed_on},
    {"exact + exact impacts, simultaneous", IntegratorKind::exact, ImpactMode::exact, ImpactLaw::simultaneous, newton},
};

}  // namespace

int main(int argc, char** argv) {
    std::vector<bench::Variant> variants;
    for (const Way& way : ways) {
        variants.push_back({way.name, [&way](Demand demand) { return (way.demands >> int(demand) & 1u) != 0; },
                            [&way](const bench::Scene& scene, double rate) -> std::unique_ptr<bench::Simulator> {
                                return bench::make_tumble(scene, rate, {way.integrator, way.mode, way.law});
                            },
                            way.mode == ImpactMode::exact});
    }
    return bench::run_accuracy(argc, argv, "Tumble", variants);
}
