// Extrapolation of the midpoint rule (Gragg 1965; Bulirsch and Stoer 1966; Hairer, Norsett, Wanner 1993, "Solving
// Ordinary Differential Equations I", section II.9): a step in 2, 4, 6, 8 and 10 parts, whose errors are series in h^2,
// and the polynomial through the five results at h = 0. Error O(h^10); 31 evaluations per step. An error of 1e-13 takes
// 120 evaluations per radian; order 8 takes 180, and order 12 hardly fewer than 120, with more rounding.
#pragma once

#include "sim/dynamics/integrators/rigid_state.h"

#include <array>
#include <cstddef>

namespace tumble {

/// A step of h seconds. Without torque the angular momentum keeps every bit.
void extrapolation_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h);

// The parts of the method, for any vector of Eigen and any rate of change Vector(const Vector&).
namespace extrapolation {

inline constexpr std::array counts{2, 4, 6, 8, 10};
inline constexpr std::size_t columns = counts.size();

/// Weights at h = 0 of the first `used` results: the product over the others of n^2 / (n^2 - m^2).
constexpr std::array<double, columns> weights(std::size_t used) {
    std::array<double, columns> list{};
    for (std::size_t i = 0; i < used; ++i) {
        list[i] = 1.0;
        const double n = double(counts[i]) * counts[i];
        for (std::size_t k = 0; k < used; ++k)
            if (k != i) list[i] *= n / (n - double(counts[k]) * counts[k]);
    }
    return list;
}

/// The change of y over h by the midpoint rule in `count` parts, and Gragg's mean over the last two points at the end;
/// `first`: the rate at y.
template <class Vector, class Rate>
Vector midpoint_change(const Vector& y, const Vector& first, double h, int count, const Rate& rate) {
    // d = the sum added to y.
    const double step = h / count;
    Vector last = Vector::Zero(y.size()), d = step * first;
    for (int i = 1; i < count; ++i) {
        const Vector next = last + 2.0 * step * rate(Vector(y + d));
        last = d;
        d = next;
    }
    return 0.5 * (last + d + step * rate(Vector(y + d)));
}

}  // namespace extrapolation
}  // namespace tumble
