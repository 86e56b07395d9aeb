// Watches of the joints benchmark.
#pragma once

#include "joints/joint_case.h"

namespace tumble::bench {

/// The note's scenes have y up and z to the viewer; the harness has z up.
inline Vector up(double x, double y, double z) { return {x, -z, y}; }

/// Error of a state at the end, from the motions of all bodies.
struct EndError {
    std::string unit;
    std::function<double(const Simulator&, const std::vector<Motion>&)> measure;
};

/// "error" at the end, if any; the largest gap and, where `energy_scale` (J) is above 0, the largest change of energy
/// over it.
std::function<std::unique_ptr<Watch>(const Scene&, double)> watch_end(const std::optional<EndError>& end,
                                                                      double energy_scale);

/// Largest changes over their starts: of energy, and of momentum and angular momentum about the origin, over the sums
/// of the magnitudes of all bodies; and the largest gap.
std::function<std::unique_ptr<Watch>(const Scene&, double)> watch_momentum();

/// Gap at the end and the speed of the fastest body there: of speed cases.
std::function<std::unique_ptr<Watch>(const Scene&, double)> watch_calm();

/// Rotation angle about a world axis of a direction that lies square to it, from another one; in -pi .. pi.
double angle_about(const Vector& axis, const Vector& from, const Vector& to);

/// A direction fixed in a body, given in the world at the start.
Vector carried(const Body& body, const Motion& motion, const Vector& direction);

}  // namespace tumble::bench
