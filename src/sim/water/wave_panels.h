// The load of waves on a body that is long beside them: the pressure of the undisturbed waves over its wet surface
// (Froude 1861, Krylov 1898), and the drag of the water that moves past each part of it.
//
// The pressure is rho g (eta - y + sum a (e^(k (y - eta)) - 1) cos phase), with eta the height of the surface: that of
// Airy's waves with the depth taken from the surface (Wheeler 1970), so that it vanishes there. Panels are divided
// until they are shorter than the waves, which are taken at their nodes. A panel that crosses the surface is clipped by
// the heights of its nodes over it. The face in the surface has no pressure: volumes and the cut by the surface follow
// from the wet panels by the divergence theorem.
#pragma once

#include "scene/description/water.h"
#include "sim/water/drag_surface.h"
#include "sim/water/panels.h"

#include <array>
#include <optional>
#include <vector>

namespace tumble {

/// World frame.
struct WavesAround {
    const WaterSurface& surface;
    const Vec3& current;  // m/s
    Pose pose;            // of the body
    double time;          // s
};

/// In the body's frame, about its origin.
struct WaveLoad {
    WetPart wet;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // m^3 and m^4, of the pressure over rho g
    DragIntegral drag;  // `heave` and `roll` relative to the water at the surface; no `plane_moment`
    /// m^3/s and m^5/s, of |dF/dv| of `drag.force` and of |dT/dw| of `drag.torque`, at least.
    double grip = 0.0;
    Mat3 turning_grip = Mat3::Zero();
    double wet_area = 0.0;     // m^2
    Vec3 flow = Vec3::Zero();  // m/s, mean of the water at the wet surface
};

/// A flat piece of the wet surface, or of the surface of the water that closes it, for the drag.
struct WetPiece {
    Vec3 area, flow;              // m^2, along the normal; m/s, of the water
    std::array<Vec3, 3> places;   // m, middles of the edges
    std::array<double, 3> rises;  // m/s, at which the water's surface rises there
};

/// The wet surface of a body at a place and a time: the load of the pressure, and the pieces on which the drag depends
/// on the motion.
struct WetHull {
    struct Part {
        const HullPart* hull;
        WaveLoad still;  // without drag
        std::vector<WetPiece> pieces;
        std::optional<WetPiece> closing;  // at the first of its places; without rises
    };
    Vec3 up = Vec3::UnitY();  // unit
    std::vector<Part> parts;

    /// `motion`: velocities in the body's frame.
    WaveLoad load(const FlowPast& motion) const;
};

class WavePanels {
public:
    /// True if a body with this longest extent (m) is long beside a wave.
    static bool needed(double length, const WaterDescription& water);

    WavePanels(const CollisionShape& shape, const WaterDescription& water, double length);
    WavePanels(const TriangleMesh& solid, const WaterDescription& water, double length);

    /// It must not outlive the panels.
    WetHull wet(const WavesAround& around) const;

private:
    void add(HullPart part, double wave);

    std::vector<Panels> parts_;
    double shown_ = 0.0;  // m, shortest wave that the panels show
};

}  // namespace tumble
