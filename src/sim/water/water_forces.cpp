#include "sim/water/water_forces.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {

WaterForces::WaterForces(const WaterDescription& water, double gravity, const Vec3& origin, std::size_t bodies)
    : description_(water), surface_(water, gravity, origin), gravity_(gravity), swimmers_(bodies) {
    for (const WaterSurface::Wave& wave : surface_.waves()) crest_ += wave.amplitude;
}

void WaterForces::add(std::size_t body, const CollisionShape& shape, std::shared_ptr<const TriangleMesh> solid,
                      double drag) {
    Swimmer& swimmer = swimmers_[body];
    swimmer.present = true;
    swimmer.shape = shape;
    swimmer.solid = std::move(solid);
    swimmer.surface = DragSurface(shape);
    swimmer.added = added_mass_of(0.5 * world_bounds(shape, {}).extent());
    swimmer.drag = drag;
    swimmer.radius = bounding_radius(shape);
    swimmer.volume = wet(swimmer, {Vec3::UnitY(), 2.0 * swimmer.radius}).volume;
    swimmer.shown = mean_projected_area(shape);
}

void WaterForces::reshape(std::size_t body, const CollisionShape& shape) {
    const Swimmer& swimmer = swimmers_[body];
    add(body, shape, nullptr, swimmer.present ? swimmer.drag : description_.drag);
}

WaterPlane WaterForces::plane_at(const Vec3& place, double time) const {
    if (surface_.still()) return {Vec3::UnitY(), surface_.level()};
    const Vec3 normal = surface_.normal(place.x(), place.z(), time);
    return {normal, normal.dot(Vec3(place.x(), surface_.height(place.x(), place.z(), time), place.z()))};
}

WetPart WaterForces::wet(const Swimmer& swimmer, const WaterPlane& seen) const {
    return swimmer.solid ? wet_part(*swimmer.solid, seen) : wet_part(swimmer.shape, seen);
}

// A wave's surface may be steep: the body's part toward it is within its radius all the same.
bool WaterForces::reaches(const Swimmer& swimmer, const Vec3& place) const {
    return swimmer.present && place.y() - 2.0 * swimmer.radius - crest_ < surface_.level();
}

// N s/m^3. A body whose cut by the water is small beside the waves that it makes loses rho omega^3 A^2 / 2 g e^(-2 k d)
// by them in heave (Haskind 1957), at the frequency omega of its free heave, over the cut and at the depth d of the
// body. At most a quarter of the critical damping: larger bodies make shorter waves.
double WaterForces::wave_making(double plane, double volume, double mass) const {
    if (!(plane > 0.0 && gravity_ > 0.0)) return 0.0;
    const double stiffness = description_.density * gravity_ * plane, square = stiffness / mass;
    const double rate = std::sqrt(square), depth = volume / plane;
    const double small = 0.5 * description_.density * rate * square * plane * plane / gravity_ *
                         exponential(-2.0 * square / gravity_ * depth);
    return std::min(small, 0.5 * std::sqrt(stiffness * mass)) / plane;
}

WaterLoad WaterForces::load(std::size_t body, const WaterBody& matter, const WaterMotion& motion, double time,
                            bool flies, double ahead) const {
    const Swimmer& swimmer = swimmers_[body];
    WaterLoad load;
    if (!reaches(swimmer, motion.pose.position)) return load;
    const WaterPlane plane = plane_at(motion.pose.position, time), seen = seen_from(motion.pose, plane);
    const WetPart part = wet(swimmer, seen);
    const bool takes_water = flies && description_.added_mass;
    const double later = takes_water && ahead > 0.0 ? volume_ahead(swimmer, motion, ahead, time) : 0.0;
    if (!(part.volume > 0.0) && !(later > 0.0)) return load;
    const double density = description_.density;
    const Mat3& rotation = motion.pose.rotation;
    const Vec3 center = part.center(), arm = rotation * center, place = motion.pose.position + arm;
    load.displaced = density * part.volume;
    if (!surface_.still()) load.water_acceleration = surface_.acceleration(place, time);
    load.buoyancy.force = load.displaced * (load.water_acceleration + gravity_ * Vec3::UnitY());
    // At the surface the pressure's gradient is along its normal, which linear waves have to the first order only: the
    // rest would turn a ball.
    const bool cut = !surface_.still() && part.volume < swimmer.volume * (1.0 - 1e-9);
    load.buoyancy.torque =
        arm.cross(cut ? Vec3(plane.normal.dot(load.buoyancy.force) * plane.normal) : load.buoyancy.force);

    const Vec3 flow = surface_.velocity(place, time), past = motion.velocity - flow;
    const FlowPast in_body{rotation.transpose() * past, rotation.transpose() * motion.angular_velocity};
    const DragIntegral drag = swimmer.surface.drag(seen, in_body);
    load.stiffness = density * gravity_ * drag.plane;
    Wrench braked{-0.5 * density * swimmer.drag * drag.force, -0.5 * density * swimmer.drag * drag.torque};
    if (description_.viscosity > 0.0) {
        // A ball of the wet volume (Stokes 1851; Kirchhoff 1876 for the torque).
        const double cube = part.volume / (4.0 / 3.0 * pi), radius = exponential(logarithm(cube) / 3.0);
        const Vec3 force =
            -6.0 * pi * description_.viscosity * radius * (in_body.velocity + in_body.angular_velocity.cross(center));
        braked.force += force;
        braked.torque += center.cross(force) - 8.0 * pi * description_.viscosity * cube * in_body.angular_velocity;
    }
    Vec3 mass = Vec3::Constant(matter.mass);
    Mat3 inverse_inertia = matter.inverse_inertia;
    if (takes_water) {
        load.added = {load.displaced * swimmer.added.linear, load.displaced * swimmer.added.angular};
        const double sinks =
            -seen.normal.dot(drag.plane * in_body.velocity + in_body.angular_velocity.cross(drag.plane_moment));
        const double enters = density * (ahead > 0.0 ? (later - part.volume) / ahead : sinks);
        if (enters > 0.0) {
            braked.force -= enters * swimmer.added.linear.cwiseProduct(in_body.velocity);
            braked.torque -= enters * swimmer.added.angular.cwiseProduct(in_body.angular_velocity);
        }
        mass += load.added.linear;
        const double waves = wave_making(drag.plane, part.volume, seen.normal.dot(seen.normal.cwiseProduct(mass)));
        braked.force -= waves * drag.heave;
        braked.torque -= waves * drag.roll;
        inverse_inertia = Mat3(matter.inertia + Mat3(load.added.angular.asDiagonal())).inverse();
    }
    const double power = -(braked.force.dot(in_body.velocity) + braked.torque.dot(in_body.angular_velocity));
    if (power > 0.0)
        load.drag_rate =
            (braked.force.dot(braked.force.cwiseQuotient(mass)) + braked.torque.dot(inverse_inertia * braked.torque)) /
            power;
    load.drag = {rotation * braked.force, rotation * braked.torque};
    return load;
}

double WaterForces::volume_ahead(const Swimmer& swimmer, const WaterMotion& motion, double ahead, double time) const {
    const Pose there{motion.pose.position + ahead * motion.velocity, motion.pose.rotation};
    return wet(swimmer, seen_from(there, plane_at(there.position, time + ahead))).volume;
}

// A quarter of its volume at most.
double WaterForces::parts_of_entry(std::size_t body, const WaterMotion& motion, double span, double time) const {
    const Swimmer& swimmer = swimmers_[body];
    const Vec3 there = motion.pose.position + span * motion.velocity;
    if (!description_.added_mass || !reaches(swimmer, there)) return 1.0;
    if (!(volume_ahead(swimmer, motion, span, time) > volume_ahead(swimmer, motion, 0.0, time))) return 1.0;
    return 4.0 * span * motion.velocity.norm() * swimmer.shown / swimmer.volume;
}

Wrench WaterForces::on_free(const WaterBody& matter, const WaterLoad& load, const Mat3& rotation, const Wrench& all) {
    const Vec3 &linear = load.added.linear, &angular = load.added.angular;
    if (linear.isZero(0.0)) return all;
    const Vec3 force =
        rotation.transpose() * all.force + linear.cwiseProduct(rotation.transpose() * load.water_acceleration);
    const Vec3 torque = rotation.transpose() * all.torque;
    const Mat3 both = matter.inertia + Mat3(angular.asDiagonal());
    return {rotation * Vec3(matter.mass * force.cwiseQuotient(Vec3::Constant(matter.mass) + linear)),
            rotation * (matter.inertia * (both.inverse() * torque))};
}

double WaterForces::potential(std::size_t body, const Pose& pose) const {
    const Swimmer& swimmer = swimmers_[body];
    if (!reaches(swimmer, pose.position)) return 0.0;
    const WaterPlane seen = seen_from(pose, {Vec3::UnitY(), surface_.level()});
    const WetPart part = wet(swimmer, seen);
    return description_.density * gravity_ * (seen.offset * part.volume - seen.normal.dot(part.moment));
}

bool WaterForces::wets(std::size_t body, const Pose& pose, double time) const {
    const Swimmer& swimmer = swimmers_[body];
    return reaches(swimmer, pose.position) && wet(swimmer, seen_from(pose, plane_at(pose.position, time))).volume > 0.0;
}

double WaterForces::wave_rate() const {
    double fastest = 0.0;
    for (const WaterSurface::Wave& wave : surface_.waves()) fastest = std::max(fastest, std::abs(wave.rate));
    return fastest;
}

}  // namespace tumble
