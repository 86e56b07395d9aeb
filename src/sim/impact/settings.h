// Constants of impacts: restitution, the active-set solver, impact laws and friction.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Approach speeds below this times |g| h, or times the load speed of the contact (load_speed()), do not bounce.
/// Gravity gives a resting contact g h in each step, its load the load speed; twice that is distinct from it. Not
/// fitted. Tests: tests/sim/contact_scenes.h, tests/physics/pressed_test.cpp.
inline constexpr double restitution_threshold = 2.0;

/// Contacts of an impact that are solved together exactly. The cost grows with the cube of the contacts: 1 ms at
/// 100, 30 ms at 256, 0.3 s at 512. Sweeps, which take over beyond, stop short of the solution in long chains.
/// Limits the cost.
inline constexpr std::size_t projection_contacts = 512;

/// The same number in the passes of a propagating impact. Sweeps are faster from fewer contacts on (heaps of 216
/// bouncing boxes: half the time of 256), and a pass need not be exact: it conserves the energy in any case. Tests:
/// Large.SweepsKeepTheEnergy and Large.RackKeepsItsMirrorImage.
inline constexpr std::size_t pass_contacts = 64;

/// A unit row is linearly dependent on others if less than this is left of it: mass ratios of 1 : 1e8 in one
/// contact leave 1e-4. Not fitted. Related test: HardInput.MassesOfOneToAHundredMillion.
inline constexpr double projection_dependent = 1e-8;

}  // namespace tumble::tuning
