// Andrews' squeezing mechanism, IFToMM's A03, as plain numbers for the benchmarks and the tests: seven bodies in a
// plane, ten hinges, a crank that turns 15.9 rad in 0.03 s. Parameters: test set for initial value problems; Hairer and
// Wanner, Solving Ordinary Differential Equations II. References: 113-bit arithmetic; the published values agree to
// 1.4e-9.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace tumble::bench::squeezer {

struct Point {
    double x = 0.0, y = 0.0;  // m
};
constexpr Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point operator*(double s, const Point& a) { return {s * a.x, s * a.y}; }
/// (cos a, sin a), and (sin a, -cos a).
inline Point along(double angle) { return {std::cos(angle), std::sin(angle)}; }
inline Point aside(double angle) { return {std::sin(angle), -std::cos(angle)}; }

inline constexpr double beta = -0.06171389001427644964, gamma = 0.45527981916307038026, phi = 0.22266839016588588467,
                        delta = 0.48736497954384255023, epsilon = 1.2305474445498211925;  // rad, at the start
inline constexpr double duration = 0.03;                                                  // s

/// A square plate with that moment of inertia about the normal of the plane; all are at rest at the start.
struct Plate {
    double mass, inertia;  // kg; kg m^2, about the center
    double angle;          // rad
    Point center;

    double side() const { return std::sqrt(6.0 * inertia / mass); }  // m
};
inline constexpr double thickness = 0.01,
                        layer = 0.02;  // m; plate k lies k layers above the plane: plates pass each other

inline constexpr double d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092, sa = 0.01874,
                        sb = 0.01043, sc = 0.018, sd = 0.02, ta = 0.02308, tb = 0.00916, u = 0.04, ua = 0.01228,
                        ub = 0.00449, zf = 0.02, zt = 0.04, fa = 0.01421;  // m, as the sources name them
inline constexpr Point a{-0.06934, -0.00227}, b{-0.03635, 0.03273}, c{0.014, 0.072};

inline std::array<Plate, 7> plates() {
    const double four = phi + delta, six = epsilon - phi;
    return {{{0.04325, 2.194e-6, beta, ra * along(beta)},
             {0.00365, 4.410e-7, beta, (rr - da) * along(beta)},
             {0.02373, 5.255e-6, gamma, b + sa * aside(gamma) + sb * along(gamma)},
             {0.00706, 5.667e-7, four, a + zt * along(delta) + (e - ea) * aside(four)},
             {0.07050, 1.169e-5, delta, a + ta * along(delta) - tb * aside(delta)},
             {0.00706, 5.667e-7, six, a + u * aside(epsilon) + (zf - fa) * along(six)},
             {0.05498, 1.912e-5, epsilon, a + ua * aside(epsilon) - ub * along(epsilon)}}};
}

inline constexpr int ground = -1;
struct Hinge {
    int first, second;  // plates, or the ground
    Point at;
};
inline std::array<Hinge, 10> hinges() {
    const Point meeting = (rr - d) * along(beta);
    return {{{ground, 0, {}},
             {0, 1, rr * along(beta)},
             {ground, 2, b},
             {ground, 4, a},
             {ground, 6, a},
             {4, 3, a + zt * along(delta)},
             {6, 5, a + u * aside(epsilon)},
             {1, 2, meeting},
             {1, 3, meeting},
             {1, 5, meeting}}};
}

/// The angles of the first seven hinges, rad: beta, Theta, gamma, delta, epsilon, Phi, Omega.
inline constexpr std::array<double, 7> starts{beta, 0.0, gamma, delta, epsilon, phi, -phi};
inline constexpr std::array<double, 7> ends{15.81077119515371,   -15.75637105841184,  0.04082224011964581,
                                            0.52440996587995407, 1.04808074104193787, -0.53473011634207958,
                                            0.53473011634207958};

inline constexpr double torque = 0.033;  // N m, on the crank, plate 0
/// From point c of the ground to a point of `spring_plate`, at the start.
inline constexpr double stiffness = 4530.0, rest_length = 0.07785;  // N/m, m
inline constexpr int spring_plate = 2;
inline Point spring_end() { return b + sc * aside(gamma) + sd * along(gamma); }

}  // namespace tumble::bench::squeezer
