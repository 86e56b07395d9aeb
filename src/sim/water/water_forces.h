// Forces of water on bodies: buoyancy and its potential, drag, and the water that moves with a body.
//
// Short bodies: the surface is taken as the plane that touches it above or below the body's center. Buoyancy is
// rho V (g + a) at the center of the wet volume V, with a the acceleration of the water there: the pressure of waves
// decays with the depth. Bodies that are long beside a wave: panels (wave_panels.h).
//
// A body that moves freely has the added mass A of its displaced water: (M + A) dv/dt = F + A du/dt, about the body's
// axes, with u the velocity of the water. A body that enters the water shares its momentum with the water that it takes
// along, -dA/dt v (von Karman 1929); one that leaves it gives none back. The waves that it makes damp its motion.
#pragma once

#include "scene/description/water.h"
#include "sim/math/wrench.h"
#include "sim/water/added_mass.h"
#include "sim/water/drag_surface.h"
#include "sim/water/wave_panels.h"
#include "sim/water/wet_volume.h"

#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// A body in water, world frame.
struct WaterMotion {
    Pose pose;  // of the center of mass
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

/// Matter of a body, for the water's forces.
struct WaterBody {
    double mass = 0.0;                                            // kg
    Mat3 inertia = Mat3::Zero(), inverse_inertia = Mat3::Zero();  // kg m^2, 1/(kg m^2), body frame
};

/// Forces on a body at a time.
struct WaterLoad {
    Wrench buoyancy, drag;
    double displaced = 0.0;                  // kg
    AddedMass added;                         // kg and kg m^2, about the body's axes
    Vec3 water_acceleration = Vec3::Zero();  // m/s^2, of the water around it
    double stiffness = 0.0;                  // N/m, of the buoyancy
    double drag_rate = 0.0;                  // 1/s, at which the drag slows the body
};

class WaterForces {
public:
    /// `gravity`: m/s^2, downward. `origin`: m, world, of the coordinates.
    WaterForces(const WaterDescription& water, double gravity, const Vec3& origin, std::size_t bodies);

    /// A dynamic body collides as `shape`. `solid`: a closed mesh in the shape's frame that is its volume, or null.
    void add(std::size_t body, const CollisionShape& shape, std::shared_ptr<const TriangleMesh> solid, double drag);

    /// The body, a piece of another one, has this shape from now on.
    void reshape(std::size_t body, const CollisionShape& shape);

    /// `flies`: the body moves freely, and takes water with it. `ahead`: s, of a step with the forces at its start:
    /// the body may enter the water within it.
    WaterLoad load(std::size_t body, const WaterBody& matter, const WaterMotion& motion, double time, bool flies,
                   double ahead = 0.0) const;
    /// The rest of all forces on a body that moves freely, after the part that accelerates the water around it.
    static Wrench on_free(const WaterBody& matter, const WaterLoad& load, const Mat3& rotation, const Wrench& all);

    bool still() const { return surface_.still(); }
    /// J, of the displaced water over the level. Precondition: still water.
    double potential(std::size_t body, const Pose& pose) const;
    /// Number of parts of the next `span` s in each of which a body that enters the water gets wet in part only.
    double parts_of_entry(std::size_t body, const WaterMotion& motion, double span, double time) const;
    /// True if a part of the body is in water; of a body on panels, if the highest crest could reach one.
    bool wets(std::size_t body, const Pose& pose, double time) const;
    /// True if the water can carry a body at rest.
    bool rests() const { return still() && description_.current.isZero(0.0); }
    /// 1/s, of the fastest wave.
    double wave_rate() const;

private:
    struct Swimmer {
        CollisionShape shape;
        std::shared_ptr<const TriangleMesh> solid;
        DragSurface surface;
        AddedMass added;
        std::optional<WavePanels> panels, solid_panels;  // of a body that is long beside a wave
        double drag = 0.0, radius = 0.0;
        double volume = 0.0, shown = 0.0;  // m^3, m^2 in the mean
        bool present = false;

        struct Wet {
            Pose pose;
            double time;  // s
            WetHull hull;
            std::optional<WetHull> solid;
        };
        /// The last answer of the panels: flights ask for several motions at one pose. No two threads ask for one body.
        mutable std::optional<Wet> wet = std::nullopt;
    };

    /// The water that touches a body, in the body's frame without another word.
    struct Immersion {
        WetPart wet;
        Vec3 up = Vec3::UnitY();                                                // unit, normal of the surface
        Wrench buoyancy;                                                        // world frame
        Vec3 water_acceleration = Vec3::Zero(), water_velocity = Vec3::Zero();  // world frame, mean
        DragIntegral drag;
        double sinks = 0.0;  // m^3/s, at which the wet volume grows
        double grip = 0.0;   // of panels, see WaveLoad
        Mat3 turning_grip = Mat3::Zero();
    };

    Immersion by_plane(const Swimmer& swimmer, const WaterMotion& motion, const WetPart& part, const WaterPlane& plane,
                       double time) const;
    const Swimmer::Wet& wet_at(const Swimmer& swimmer, const Pose& pose, double time) const;
    Immersion by_panels(const Swimmer& swimmer, const WaterMotion& motion, double time) const;
    /// 1/s, of the drag and of the water that a body takes along, `enters` kg/s.
    double panel_rate(const Immersion& immersion, const Swimmer& swimmer, double enters, const Vec3& mass,
                      const Mat3& inverse_inertia) const;
    WaterPlane plane_at(const Vec3& place, double time) const;
    double wave_making(double plane, double volume, double mass) const;
    WetPart wet(const Swimmer& swimmer, const WaterPlane& seen) const;
    bool reaches(const Swimmer& swimmer, const Vec3& place) const;
    /// m^3, of the wet part after `ahead` s at the present velocity.
    double volume_ahead(const Swimmer& swimmer, const WaterMotion& motion, double ahead, double time) const;

    WaterDescription description_;
    WaterSurface surface_;
    double gravity_, crest_ = 0.0;  // m/s^2; m, highest crest over the level
    std::vector<Swimmer> swimmers_;
};

}  // namespace tumble
