// Sine, cosine, arc tangent, exponential, logarithm and hypotenuse with the same bytes on every x86-64. glibc selects
// variants with fused operations at run time, and other libraries round otherwise: they differ in the last bit between
// machines, so the trajectory must depend on these functions only. They use only + - * / and sqrt.
#pragma once

namespace tumble {

struct SinCos {
    double sin, cos;
};

/// Sine and cosine of x in radians; error below 2e-16 for |x| <= 1.6e9. Beyond, x itself is a phase known to 1e-7 rad
/// only; the error stays of the order of the rounding of x.
SinCos sincos(double x);

/// The angle whose tangent is x, in [-pi/2, pi/2]; relative error below 4e-16.
double arc_tangent(double x);

/// The angle of the point (x, y), in (-pi, pi]; error below 1e-15. atan2_stable(0, 0) is 0.
double atan2_stable(double y, double x);

/// e^x; relative error below 4e-16. Overflows to infinity and underflows to 0.
double exponential(double x);

/// The natural logarithm of x > 0; relative error below 4e-16, near 1 absolute.
double logarithm(double x);

/// sqrt(x^2 + y^2) without overflow or underflow on the way; relative error below 2.3e-16, one unit in the last place.
/// With an infinite argument infinity, otherwise with NaN NaN.
double hypotenuse(double x, double y);

struct TanhSech {
    double tanh, sech;
};

/// Hyperbolic tangent and 1/cosh; error below 4e-16, sech also relative to itself.
TanhSech tanh_sech(double x);

inline constexpr double pi = 3.14159265358979323846;

}  // namespace tumble
