// Coulomb friction of a uniform pressure on an area that slides by v and spins by w about its normal.
//
// A force f and a torsional moment T about the area's centroid, under the load N: pure sliding has f = mu N, pure
// spinning T = mu N d, with d the mean distance of the area from its centroid (contact_area.h). Both at once lie on an
// ellipsoid
//   f^2 + (T / l)^2 = (mu N k)^2,   T / f = l^2 w / v,
// as in Howe and Cutkosky (1996), but with a lever l and a limit k that depend on the ratio of spin to slip. One
// ellipsoid for all, k = 1 and l = d, gives a fast spin with little sliding half as much friction again as it has. l
// and k are those of a disc of the same d, whose radius is 3/2 d: with x = (3/2 d w)^2 / (v^2 + (3/2 d w)^2)
// and y = 1 - x
//   l^2 / d^2 = (9/16 y^2 + 0.45 x^2) / (y^2 + 0.3 x^2)     (y -> 1: 9/16, x -> 1: 3/2, both exact),
//   k^2 = 1 - t (0.58 + 0.42 t) / 3,  t = (l^2 / d^2 - 9/16) / (15/16)     (t = 0: 1, t = 1: 2/3, both exact),
// with 0.3 and 0.42 fitted to the disc's integrals (Farkas, Bartels, Unger and Wolf 2003, "Frictional coupling between
// sliding and spinning motion"): f and T agree within 1.6 % of mu N and of mu N d.
//
// The load need not be uniform. Points with the normal impulses N_i at p_i from the centroid have
//   N d = spread sum N_i |p_i| + (1 - spread) |sum N_i p_i|
// (Manifold::spread): the area's own mean where the load's center is the centroid; elsewhere enough to hold the moment
// about the centroid of friction at the load's center.
#pragma once

#include <cmath>

namespace tumble::spin_friction {

inline constexpr double disc = 9.0 / 4.0;  // squared ratio of a disc's radius to its mean distance
inline constexpr double sliding_square = 9.0 / 16.0, spinning_square = 3.0 / 2.0;  // l^2 / d^2
inline constexpr double spinning_limit = 2.0 / 3.0;                                // k^2
inline constexpr double steep = 0.3, bent = 0.42;                                  // fitted

struct Limit {
    double lever = 1.0;  // l / d
    double load = 1.0;   // k
};

/// Precondition: of `slip` and `spin`, which are v^2 and (d w)^2, one is not zero.
inline Limit limit(double slip, double spin) {
    const double x = disc * spin / (slip + disc * spin), y = 1.0 - x;
    const double square = (sliding_square * y * y + steep * spinning_square * x * x) / (y * y + steep * x * x);
    const double t = (square - sliding_square) / (spinning_square - sliding_square);
    return {std::sqrt(square), std::sqrt(1.0 - t * (1.0 - bent + bent * t) * (1.0 - spinning_limit))};
}

}  // namespace tumble::spin_friction
