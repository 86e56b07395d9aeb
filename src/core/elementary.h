// Sine, cosine and arc tangent whose bytes are the same on every x86-64.
// glibc picks fused-multiply-add variants of its own at run time, which differ in the last bit between machines;
// whatever the simulation's trajectory depends on uses these instead. Built from + - * / and sqrt only.
#pragma once

namespace tumble {

struct SinCos {
    double sin, cos;
};

/// Sine and cosine of x in radians, |x| <= 1e6 (beyond that the reduction loses digits); error below 1e-15.
SinCos sincos(double x);

/// The angle of the point (x, y), in (-pi, pi]; error below 1e-15. atan2_stable(0, 0) is 0.
double atan2_stable(double y, double x);

inline constexpr double pi = 3.14159265358979323846;

}  // namespace tumble
