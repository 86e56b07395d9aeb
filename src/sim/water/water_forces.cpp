#include "sim/water/water_forces.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// Share of its volume up to which a body on panels counts as dry: rounding of their sums.
constexpr double least_wet = 1e-12;

/// In the body's frame.
FlowPast past(const WaterMotion& motion, const Vec3& water_velocity) {
    const Vec3 velocity = motion.velocity - water_velocity;
    return {motion.pose.rotation.transpose() * velocity, motion.pose.rotation.transpose() * motion.angular_velocity};
}

}  // namespace

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
    swimmer.wet.reset();
    swimmer.panels.reset();
    swimmer.solid_panels.reset();
    const double length = world_bounds(shape, {}).extent().maxCoeff();
    if (!WavePanels::needed(length, description_)) return;
    swimmer.panels.emplace(shape, description_, length);
    if (swimmer.solid) swimmer.solid_panels.emplace(*swimmer.solid, description_, length);
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

WaterForces::Immersion WaterForces::by_plane(const Swimmer& swimmer, const WaterMotion& motion, const WetPart& part,
                                             const WaterPlane& plane, double time) const {
    const WaterPlane seen = seen_from(motion.pose, plane);
    Immersion immersion;
    immersion.up = seen.normal;
    immersion.wet = part;
    const double volume = part.volume;
    const Mat3& rotation = motion.pose.rotation;
    const Vec3 arm = rotation * immersion.wet.center(), place = motion.pose.position + arm;
    if (!surface_.still()) immersion.water_acceleration = surface_.acceleration(place, time);
    const double displaced = description_.density * volume;
    immersion.buoyancy.force = displaced * (immersion.water_acceleration + gravity_ * Vec3::UnitY());
    // At the surface the pressure's gradient is along its normal, which linear waves have to the first order only: the
    // rest would turn a ball.
    const bool cut = !surface_.still() && volume < swimmer.volume * (1.0 - 1e-9);
    immersion.buoyancy.torque =
        arm.cross(cut ? Vec3(plane.normal.dot(immersion.buoyancy.force) * plane.normal) : immersion.buoyancy.force);
    immersion.water_velocity = surface_.velocity(place, time);
    const FlowPast in_body = past(motion, immersion.water_velocity);
    immersion.drag = swimmer.surface.drag(seen, in_body);
    immersion.sinks = -seen.normal.dot(immersion.drag.plane * in_body.velocity +
                                       in_body.angular_velocity.cross(immersion.drag.plane_moment));
    return immersion;
}

const WaterForces::Swimmer::Wet& WaterForces::wet_at(const Swimmer& swimmer, const Pose& pose, double time) const {
    std::optional<Swimmer::Wet>& last = swimmer.wet;
    if (last && last->time == time && last->pose.position == pose.position && last->pose.rotation == pose.rotation)
        return *last;
    const WavesAround around{surface_, description_.current, pose, time};
    last = {pose, time, swimmer.panels->wet(around), std::nullopt};
    if (swimmer.solid_panels) last->solid = swimmer.solid_panels->wet(around);
    return *last;
}

WaterForces::Immersion WaterForces::by_panels(const Swimmer& swimmer, const WaterMotion& motion, double time) const {
    const FlowPast in_body = past(motion, Vec3::Zero());
    const Swimmer::Wet& wet = wet_at(swimmer, motion.pose, time);
    const WaveLoad load = wet.hull.load(in_body), pressed = wet.solid ? wet.solid->load(in_body) : load;
    const Mat3& rotation = motion.pose.rotation;
    Immersion immersion;
    immersion.up = rotation.transpose() * Vec3::UnitY();
    immersion.water_velocity = surface_.velocity(motion.pose.position, time);
    if (!(pressed.wet.volume > least_wet * swimmer.volume)) return immersion;
    immersion.wet = pressed.wet;
    const double weight = description_.density * gravity_;
    immersion.buoyancy = {rotation * Vec3(weight * pressed.force), rotation * Vec3(weight * pressed.torque)};
    immersion.water_acceleration = gravity_ * (rotation * Vec3(pressed.force / pressed.wet.volume) - Vec3::UnitY());
    immersion.water_velocity = rotation * load.flow;
    immersion.drag = load.drag;
    immersion.sinks = -immersion.up.dot(load.drag.heave);
    immersion.grip = load.grip;
    immersion.turning_grip = load.turning_grip;
    return immersion;
}

WaterLoad WaterForces::load(std::size_t body, const WaterBody& matter, const WaterMotion& motion, double time,
                            bool flies, double ahead) const {
    const Swimmer& swimmer = swimmers_[body];
    WaterLoad load;
    if (!reaches(swimmer, motion.pose.position)) return load;
    const bool panels = swimmer.panels.has_value();
    Immersion immersion;
    WaterPlane plane;
    if (panels) {
        immersion = by_panels(swimmer, motion, time);
    } else {
        plane = plane_at(motion.pose.position, time);
        immersion.wet = wet(swimmer, seen_from(motion.pose, plane));
    }
    const double volume = immersion.wet.volume;
    const bool takes_water = flies && description_.added_mass;
    // A body on panels that is wet already gets wetter at the rate of its sinking.
    const bool looks_ahead = takes_water && ahead > 0.0 && !(panels && volume > 0.0);
    const double later = looks_ahead ? volume_ahead(swimmer, motion, ahead, time) : 0.0;
    if (!(volume > 0.0) && !(later > 0.0)) return load;
    if (!panels) immersion = by_plane(swimmer, motion, immersion.wet, plane, time);
    const double density = description_.density;
    const Mat3& rotation = motion.pose.rotation;
    const Vec3 center = immersion.wet.center();
    load.displaced = density * volume;
    load.water_acceleration = immersion.water_acceleration;
    load.buoyancy = immersion.buoyancy;

    const FlowPast in_body = past(motion, immersion.water_velocity);
    const DragIntegral& drag = immersion.drag;
    load.stiffness = density * gravity_ * drag.plane;
    Wrench braked{-0.5 * density * swimmer.drag * drag.force, -0.5 * density * swimmer.drag * drag.torque};
    if (description_.viscosity > 0.0) {
        // A ball of the wet volume (Stokes 1851; Kirchhoff 1876 for the torque).
        const double cube = volume / (4.0 / 3.0 * pi), radius = exponential(logarithm(cube) / 3.0);
        const Vec3 force =
            -6.0 * pi * description_.viscosity * radius * (in_body.velocity + in_body.angular_velocity.cross(center));
        braked.force += force;
        braked.torque += center.cross(force) - 8.0 * pi * description_.viscosity * cube * in_body.angular_velocity;
    }
    double enters = 0.0;  // kg/s
    Vec3 mass = Vec3::Constant(matter.mass);
    Mat3 inverse_inertia = matter.inverse_inertia;
    if (takes_water) {
        load.added = {load.displaced * swimmer.added.linear, load.displaced * swimmer.added.angular};
        enters = density * (looks_ahead ? (later - volume) / ahead : immersion.sinks);
        if (panels && ahead > 0.0) enters = std::min(enters, density * (swimmer.volume - volume) / ahead);
        if (enters > 0.0) {
            braked.force -= enters * swimmer.added.linear.cwiseProduct(in_body.velocity);
            braked.torque -= enters * swimmer.added.angular.cwiseProduct(in_body.angular_velocity);
        }
        mass += load.added.linear;
        const double waves = wave_making(drag.plane, volume, immersion.up.dot(immersion.up.cwiseProduct(mass)));
        braked.force -= waves * drag.heave;
        braked.torque -= waves * drag.roll;
        inverse_inertia = Mat3(matter.inertia + Mat3(load.added.angular.asDiagonal())).inverse();
    }
    const double power = -(braked.force.dot(in_body.velocity) + braked.torque.dot(in_body.angular_velocity));
    if (panels)
        load.drag_rate = panel_rate(immersion, swimmer, enters, mass, inverse_inertia);
    else if (power > 0.0)
        load.drag_rate =
            (braked.force.dot(braked.force.cwiseQuotient(mass)) + braked.torque.dot(inverse_inertia * braked.torque)) /
            power;
    load.drag = {rotation * braked.force, rotation * braked.torque};
    return load;
}

// The water moves past each panel at a speed of its own: forces that cancel brake a body all the same.
double WaterForces::panel_rate(const Immersion& immersion, const Swimmer& swimmer, double enters, const Vec3& mass,
                               const Mat3& inverse_inertia) const {
    const double form = 0.5 * description_.density * swimmer.drag, lightest = mass.minCoeff();
    double rate = form * (immersion.grip / lightest + inverse_inertia.cwiseProduct(immersion.turning_grip).sum());
    if (enters > 0.0)
        rate += enters * std::max(swimmer.added.linear.cwiseQuotient(mass).maxCoeff(),
                                  swimmer.added.angular.cwiseProduct(inverse_inertia.diagonal()).maxCoeff());
    if (description_.viscosity > 0.0) {
        const double cube = immersion.wet.volume / (4.0 / 3.0 * pi), radius = exponential(logarithm(cube) / 3.0);
        rate += pi * description_.viscosity *
                (6.0 * radius / lightest + 8.0 * cube * inverse_inertia.diagonal().maxCoeff());
    }
    return rate;
}

double WaterForces::volume_ahead(const Swimmer& swimmer, const WaterMotion& motion, double ahead, double time) const {
    const Pose there{motion.pose.position + ahead * motion.velocity, motion.pose.rotation};
    if (swimmer.panels) {
        const WavePanels& panels = swimmer.solid_panels ? *swimmer.solid_panels : *swimmer.panels;
        return panels.wet({surface_, description_.current, there, time + ahead}).load({}).wet.volume;
    }
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
    if (!reaches(swimmer, pose.position)) return false;
    if (swimmer.panels) return world_bounds(swimmer.shape, pose).min.y() < surface_.level() + crest_;
    return wet(swimmer, seen_from(pose, plane_at(pose.position, time))).volume > 0.0;
}

double WaterForces::wave_rate() const {
    double fastest = 0.0;
    for (const WaterSurface::Wave& wave : surface_.waves()) fastest = std::max(fastest, std::abs(wave.rate));
    return fastest;
}

}  // namespace tumble
