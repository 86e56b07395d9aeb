// Carlson's symmetric elliptic integrals of real arguments. Each duplication reduces the distance between the arguments
// fourfold, until a Taylor series about their mean is accurate. Carlson 1995, "Numerical computation of real or complex
// elliptic integrals", Numerical Algorithms 10; DLMF 19.16 and 19.36.
#pragma once

namespace tumble {

/// R_F(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x)(t + y)(t + z)), for x, y, z >= 0, at most one of them 0.
/// Relative error below 1e-15.
double carlson_rf(double x, double y, double z);

/// R_J(x, y, z, p) = 3/2 int_0^inf dt / (sqrt((t + x)(t + y)(t + z)) (t + p)), for x, y, z >= 0, at most one of them 0,
/// and p >= max(x, y, z). Relative error below 2e-15.
double carlson_rj(double x, double y, double z, double p);

/// R_C(1, 1 + e) = 1/2 int_0^inf dt / (sqrt(t + 1) (t + 1 + e)) = atan(sqrt(e)) / sqrt(e), for e >= 0.
/// Relative error below 1e-15.
double carlson_rc1(double e);

}  // namespace tumble
