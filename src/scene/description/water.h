// A body of water without sides or bottom, and its surface: shared by the simulation and the drawing.
#pragma once

#include "core/color.h"
#include "core/vector.h"

#include <vector>

namespace tumble {

/// A wave on deep water: its surface is (height / 2) cos(k (d . x) - omega t + phase) above the level, with
/// k = 2 pi / length, omega^2 = g k, and d the direction.
struct WaterWave {
    double height = 0.0;            // m, from trough to crest
    double length = 1.0;            // m, from crest to crest
    Vec3 direction{1.0, 0.0, 0.0};  // unit, horizontal
    double phase = 0.0;             // degrees
};

struct WaterDescription {
    double level = 0.0;           // m, y of the still surface
    double density = 1000.0;      // kg/m^3
    double drag = 1.0;            // drag coefficient
    double viscosity = 0.0;       // Pa s
    bool added_mass = true;       // bodies carry water with them
    Vec3 current = Vec3::Zero();  // m/s, horizontal; it carries the waves
    Color color{0x2a, 0x6f, 0x8f};
    bool visible_in_aov = true;
    std::vector<WaterWave> waves;
};

/// The surface by linear theory (Airy 1845): crests of steep waves are not sharper than troughs.
class WaterSurface {
public:
    struct Wave {
        Vec3 k;            // 1/m, horizontal: 2 pi / length along the direction
        double amplitude;  // m, half the height
        double rate;       // rad/s, of the phase at a place that does not move
        double omega;      // rad/s, of the phase at a place that the current carries
        double phase;      // rad
        double decay;      // 1/m, 2 pi / length
    };

    WaterSurface() = default;
    /// `gravity`: m/s^2, downward. `origin`: m, world, of the coordinates.
    WaterSurface(const WaterDescription& water, double gravity, const Vec3& origin = Vec3::Zero());

    bool still() const { return waves_.empty(); }
    double level() const { return level_; }  // m, y without waves
    const std::vector<Wave>& waves() const { return waves_; }

    /// m, y of the surface at a place and time (s).
    double height(double x, double z, double time) const;
    /// Upward, unit.
    Vec3 normal(double x, double z, double time) const;
    /// m/s, of the water at a point below the surface: the current, and the motion by the waves.
    Vec3 velocity(const Vec3& point, double time) const;
    /// m/s^2, of the water at such a point, by waves.
    Vec3 acceleration(const Vec3& point, double time) const;

private:
    double level_ = 0.0;
    Vec3 current_ = Vec3::Zero();
    std::vector<Wave> waves_;
};

}  // namespace tumble
