#include "stability/stability_case.h"

namespace tumble::bench {

std::vector<double> stability_rates() { return {30.0, 60.0, 120.0, 240.0, 480.0, 960.0, 1920.0}; }

std::vector<StabilityCase> stability_cases() {
    std::vector<StabilityCase> cases;
    add_loads(cases);
    add_spins(cases);
    add_strikes(cases);
    add_joints(cases);
    add_breaking(cases);
    add_water(cases);
    return cases;
}

}  // namespace tumble::bench
