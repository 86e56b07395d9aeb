#include "sim/dynamics/integrators/extrapolation.h"

#include "sim/dynamics/integrators/rigid_state.h"

#include <array>

namespace tumble {
namespace {

struct Part {
    int count;      // n parts of h/n
    double weight;  // of its result at h = 0: the product over the others of n^2 / (n^2 - m^2)
};
constexpr std::array counts{2, 4, 6, 8, 10};
constexpr auto substep_counts = [] {
    std::array<Part, counts.size()> list{};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        list[i] = {counts[i], 1.0};
        const double n = double(counts[i]) * counts[i];
        for (const int other : counts)
            if (other != counts[i]) list[i].weight *= n / (n - double(other) * other);
    }
    return list;
}();

}  // namespace

void extrapolation_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h) {
    const StateVector y = vector_of(state);
    const StateVector first = rate_of_change(y, mass, forces);
    StateVector change = StateVector::Zero();
    for (const Part& part : substep_counts) {
        // d = the sum added to y. The midpoint rule, and Gragg's mean over the last two points at the end.
        const double step = h / part.count;
        StateVector last = StateVector::Zero(), d = step * first;
        for (int i = 1; i < part.count; ++i) {
            const StateVector next = last + 2.0 * step * rate_of_change(y + d, mass, forces);
            last = d;
            d = next;
        }
        change += part.weight * (0.5 * (last + d + step * rate_of_change(y + d, mass, forces)));
    }
    state = state_of(StateVector(y + change));
}

}  // namespace tumble
