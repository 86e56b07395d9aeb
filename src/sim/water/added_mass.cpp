#include "sim/water/added_mass.h"

#include <cmath>

namespace tumble {
namespace {

/// Carlson's R_D(x, y, z) = 3/2 int_0^inf dt / (sqrt((t + x)(t + y)) (t + z)^(3/2)) by duplication (Carlson 1995): each
/// of the rounds divides the difference of the arguments by 4, and the error by 16.
double carlson_rd(double x, double y, double z) {
    double sum = 0.0, share = 1.0;
    for (int round = 0; round < 40; ++round) {
        const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z), l = rx * ry + ry * rz + rz * rx;
        sum += 3.0 * share / (rz * (z + l));
        share *= 0.25;
        x = 0.25 * (x + l);
        y = 0.25 * (y + l);
        z = 0.25 * (z + l);
    }
    const double mean = (x + y + 3.0 * z) / 5.0;
    return sum + share / (mean * std::sqrt(mean));
}

}  // namespace

AddedMass added_mass_of(const Vec3& half) {
    // For axis i: abc int_0^inf dt / ((a_i^2 + t) sqrt((a^2 + t)(b^2 + t)(c^2 + t))); the sum is 2.
    const Vec3 in_units = half / half.maxCoeff(), square = in_units.cwiseProduct(in_units);
    Vec3 integral;
    for (int i = 0; i < 3; ++i)
        integral[i] = 2.0 / 3.0 * in_units.prod() * carlson_rd(square[(i + 1) % 3], square[(i + 2) % 3], square[i]);
    AddedMass added;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        added.linear[i] = integral[i] / (2.0 - integral[i]);
        const double difference = square[j] - square[k], sum = square[j] + square[k];
        const double under = 2.0 * difference + sum * (integral[j] - integral[k]);
        if (difference != 0.0 && under != 0.0)
            added.angular[i] = 0.2 * difference * difference * (integral[k] - integral[j]) / under;
    }
    added.angular *= half.maxCoeff() * half.maxCoeff();
    return added;
}

}  // namespace tumble
