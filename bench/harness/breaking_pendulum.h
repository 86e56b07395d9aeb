// A rod of 1 m, 0.1 m thick, 1 kg, from 90 degrees on a hinge that breaks, for the benchmarks and the tests: closed
// form of 30 digits.
#pragma once

namespace tumble::bench::breaking_pendulum {

inline constexpr double strength = 15.0;                      // N
inline constexpr double time = 0.300354695438428074;          // s, of the break
inline constexpr double angle = 0.918177608833369149;         // rad from hanging, at the break
inline constexpr double angular_speed = 4.22224580764613828;  // rad/s

}  // namespace tumble::bench::breaking_pendulum
