#include "sim/dynamics/forces.h"

#include "core/sort_unique.h"
#include "sim/dynamics/body_builder.h"
#include "sim/math/free_rotation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tumble {
namespace {

/// ForceDescription::body of an explosion's force.
constexpr std::size_t of_explosion = SIZE_MAX;

/// Least part of a step in which an explosion acts: in less, forces would be beyond all others by orders of magnitude.
constexpr double least_blast = 0.25;

bool covers(const ForceDescription& f, double from, double to) { return f.start <= from && f.end >= to; }

void add(Wrench& sum, const ForceDescription& f, const Body& body, const Mat3& rotation) {
    const Vec3 force = f.body_frame ? Vec3(rotation * f.force) : f.force;
    const Vec3 r = rotation * (f.point - body.center_of_mass);
    sum.force += force;
    sum.torque += r.cross(force);  // notes eq. 6
}

// Index in the simulation of each body of the scene.
std::vector<std::size_t> places_of(std::size_t count, std::span<const std::uint32_t> order) {
    std::vector<std::size_t> places(count);
    for (std::size_t i = 0; i < count; ++i) places[order.empty() ? i : order[i]] = i;
    return places;
}

/// A mesh that encloses its mass is its own volume in water; a shell and a hull displace what their hull does.
std::shared_ptr<const TriangleMesh> solid_of(const BodyDescription& d, const Vec3& center_of_mass) {
    const auto* mesh = std::get_if<MeshShape>(&d.shape);
    if (mesh == nullptr || mesh->mass_from != MassFrom::solid) return nullptr;
    auto solid = std::make_shared<TriangleMesh>(mesh->asset->mesh);
    for (Vec3& v : solid->vertices) v -= center_of_mass;
    return solid;
}

std::shared_ptr<WaterForces> water_of(const SceneDescription& scene, const std::vector<std::size_t>& places,
                                      const Vec3& origin) {
    if (!scene.water) return nullptr;
    auto water =
        std::make_shared<WaterForces>(*scene.water, scene.simulation.gravity.norm(), origin, scene.bodies.size());
    BodyBuilder builder(scene.contact);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& d = scene.bodies[i];
        if (!d.dynamic()) continue;
        const Body body = builder.build(d, scene.simulation.integrator);
        water->add(places[i], body.collider, solid_of(d, body.center_of_mass),
                   d.water_drag.value_or(scene.water->drag));
    }
    return water;
}

WaterBody matter_of(const Body& body) { return {body.mass, body.inertia_body, body.inverse_inertia_body}; }

WaterMotion motion_of(const Body& body) { return {body.pose(), body.velocity, body.angular_velocity}; }

Wrench sum_of(const Wrench& a, const Wrench& b, double share = 1.0) {
    return {a.force + share * b.force, a.torque + share * b.torque};
}

WaterMotion motion_at(const WaterBody& matter, const FlightPoint& at) {
    const Vec3 in_body = matter.inverse_inertia * (at.rotation.transpose() * at.angular_momentum);
    return {{at.position, at.rotation}, at.velocity, at.rotation * in_body};
}

/// The bodies with forces between each other at their present places.
struct PresentPairs {
    PresentPairs(const PairForces& pairs, const std::vector<Body>& bodies) {
        for (const std::uint32_t i : pairs.bodies()) {
            const Body& body = bodies[i];
            points.push_back({pair_mass(body), body.position, body.velocity});
            if (pairs.has_torques()) turns.push_back({body.rotation});
        }
    }
    operator PairBodies() const { return {points, turns}; }

    std::vector<MassPoint> points;
    std::vector<PairTurn> turns;
};

void operator+=(Wrench& sum, const Wrench& other) {
    sum.force += other.force;
    sum.torque += other.torque;
}

}  // namespace

ForceField::ForceField(const SceneDescription& scene, std::span<const std::uint32_t> order, const Vec3& origin)
    : gravity_(scene.simulation.gravity),
      wind_(scene.wind),
      at_points_(scene.bodies.size()),
      place_(scene.fields, origin),
      explosions_(scene.explosions, origin),
      pairs_(scene.pair_forces, places_of(scene.bodies.size(), order)),
      held_(pairs_.bodies().size()),
      water_(water_of(scene, places_of(scene.bodies.size(), order), origin)) {
    const std::vector<std::size_t> places = places_of(scene.bodies.size(), order);
    for (const ForceDescription& f : scene.forces) at_points_[places[f.body]].push_back(f);
    for (std::size_t body = 0; body < places.size(); ++body)
        if (!at_points_[places[body]].empty() || (!explosions_.empty() && scene.bodies[body].dynamic()))
            pushed_.push_back(std::uint32_t(places[body]));
    std::sort(pushed_.begin(), pushed_.end());
}

void ForceField::light_explosions(const std::vector<Body>& bodies, double from, double to) {
    if (explosions_.empty()) return;
    for (const std::uint32_t i : blasted_)
        std::erase_if(at_points_[i], [](const ForceDescription& f) { return f.body == of_explosion; });
    blasted_.clear();
    for (const ExplosionDescription& explosion : explosions_.within(from, to)) {
        const double start = std::min(explosion.time, to - least_blast * (to - from));
        for (const std::uint32_t i : pushed_) {
            const Body& body = bodies[i];
            const Vec3 impulse = body.dynamic() ? impulse_of(explosion, body.collider, body.pose()) : Vec3::Zero();
            if (impulse.isZero(0.0)) continue;
            blasted_.push_back(i);
            at_points_[i].push_back({of_explosion, body.pose().to_body(explosion.center) + body.center_of_mass,
                                     impulse / (to - start), false, start, to});
        }
    }
}

void ForceField::move_points(std::size_t from, const std::function<std::uint32_t(const Vec3& point)>& to) {
    for (const ForceDescription& force : std::exchange(at_points_[from], {})) {
        if (force.body == of_explosion) continue;  // each body takes its own
        const std::uint32_t body = to(force.point);
        at_points_[body].push_back(force);
        pushed_.push_back(body);
    }
    sort_unique(pushed_);
}

void ForceField::each_point(std::size_t index, double time,
                            const std::function<void(const ForceDescription&)>& use) const {
    for (const ForceDescription& f : at_points_[index])
        if (f.body != of_explosion && time >= f.start && time < f.end) use(f);
}

void ForceField::hold_pairs(const std::vector<Body>& bodies, double from, double to) {
    if (pairs_.empty()) return;
    std::fill(held_.begin(), held_.end(), Wrench());
    pairs_.add_mean(PresentPairs(pairs_, bodies), from, to, held_);
}

double ForceField::potential(const std::vector<Body>& bodies) const {
    double sum = pairs_.empty() ? 0.0 : pairs_.potential(PresentPairs(pairs_, bodies));
    if (place_.empty()) return sum;
    for (const Body& body : bodies)
        if (body.dynamic()) sum += place_.potential({body.mass, body.position, body.velocity});
    return sum;
}

double ForceField::pair_rate(const std::vector<Body>& bodies, double time) const {
    return pairs_.rate(PresentPairs(pairs_, bodies), time);
}

Wrench ForceField::held(std::size_t index) const {
    const auto members = pairs_.bodies();
    const auto found = std::lower_bound(members.begin(), members.end(), std::uint32_t(index));
    if (found == members.end() || *found != index) return {};
    return held_[std::size_t(found - members.begin())];
}

Wrench ForceField::weather(const Body& body, const Vec3& velocity) const {
    Wrench sum;
    sum.force = body.mass * body.fall(gravity_);
    if (wind_) {
        // F = 1/2 rho C_d A |u| u with u the air's velocity relative to the body.
        const Vec3 u = wind_->velocity - velocity;
        sum.force += 0.5 * wind_->density * wind_->drag * body.drag_area * u.norm() * u;
    }
    return sum;
}

Wrench ForceField::fields(std::size_t index, const Body& body, double from, double to) const {
    Wrench sum = dry_fields(index, body, from, to);
    if (water_) add_water(sum, index, body, from, to - from, false);
    return sum;
}

Wrench ForceField::dry_fields(std::size_t index, const Body& body, double from, double to) const {
    Wrench sum = weather(body, body.velocity);
    if (!place_.empty()) sum.force += place_.mean({body.mass, body.position, body.velocity}, from, to);
    if (!pairs_.empty()) sum += held(index);
    return sum;
}

// Adds the forces of the water over a step of h seconds to the others, and takes from all what the water around a free
// body takes. The drag is that of the mean velocity, as in one dimension: it stops no body within a step. A thin plate
// whose buoyancy would turn its motion within a step moves as if heavier, and no torque turns a body by a radian.
void ForceField::add_water(Wrench& sum, std::size_t index, const Body& body, double time, double h, bool flies) const {
    const WaterBody matter = matter_of(body);
    const WaterLoad load = water_->load(index, matter, motion_of(body), time, flies, h);
    sum = sum_of(sum_of(sum, load.buoyancy), load.drag, 1.0 / (1.0 + h * load.drag_rate));
    if (flies) sum = WaterForces::on_free(matter, load, body.rotation, sum);
    const double stiff = load.stiffness * h * h;
    if (stiff > body.mass) sum = sum_of({}, sum, body.mass / stiff);
    const double turn = h * h * (matter.inverse_inertia * (body.rotation.transpose() * sum.torque)).norm();
    if (turn > 1.0) sum.torque /= turn;
}

Wrench ForceField::water(std::size_t index, const Body& body, double from, double to, bool flies) const {
    const Wrench dry = throughout_dry(index, body, from, to);
    Wrench all = dry;
    add_water(all, index, body, from, to - from, flies);
    return sum_of(all, dry, -1.0);
}

double ForceField::water_potential(const std::vector<Body>& bodies) const {
    double sum = 0.0;
    if (!water_ || !water_->still()) return sum;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].dynamic()) sum += water_->potential(i, bodies[i].pose());
    return sum;
}

bool ForceField::afloat(std::size_t index, const Body& body) const {
    return water_ && water_->rests() && water_->wets(index, body.pose(), 0.0);
}

bool ForceField::stirred(std::size_t index, const Body& body, double time) const {
    return water_ && !water_->still() && water_->wets(index, body.pose(), time);
}

template <class Choose>
void ForceField::add_points(Wrench& sum, std::size_t index, const Body& body, const Mat3& rotation,
                            const Choose& choose) const {
    for (const ForceDescription& f : at_points_[index])
        if (choose(f)) add(sum, f, body, rotation);
}

Wrench ForceField::at(std::size_t index, const Body& body, const Vec3& position, const BodyVelocity& velocity,
                      const Mat3& rotation, double time) const {
    Wrench sum = alone(index, body, {body.mass, position, velocity.velocity}, rotation, time);
    if (!pairs_.empty()) sum += held(index);
    if (!water_) return sum;
    const WaterLoad load = water_->load(
        index, matter_of(body), {{position, rotation}, velocity.velocity, velocity.angular_velocity}, time, false);
    return sum_of(sum_of(sum, load.buoyancy), load.drag);
}

Wrench ForceField::in_flight(std::size_t index, const Body& body, const FlightPoint& at, const FlightTime& time,
                             const Wrench& pull) const {
    Wrench sum = alone(index, body, {body.mass, at.position, at.velocity}, at.rotation, time.middle);
    if (!pairs_.empty()) sum += pull;
    if (!water_) return sum;
    const WaterBody matter = matter_of(body);
    const WaterLoad load = water_->load(index, matter, motion_at(matter, at), time.start + at.elapsed, true);
    return WaterForces::on_free(matter, load, at.rotation, sum_of(sum_of(sum, load.buoyancy), load.drag));
}

double ForceField::parts_in_water(std::size_t index, const Body& body, const FlightPoint& at, double from,
                                  double to) const {
    const double span = to - from;
    return std::max(span * water_rate(index, body, at, from),
                    water_->parts_of_entry(index, motion_at(matter_of(body), at), span, from));
}

double ForceField::water_rate(std::size_t index, const Body& body, const FlightPoint& at, double time) const {
    const WaterBody matter = matter_of(body);
    const WaterLoad load = water_->load(index, matter, motion_at(matter, at), time, true);
    if (!(load.displaced > 0.0)) return 0.0;
    const Vec3 spin = matter.inverse_inertia * (at.rotation.transpose() * at.angular_momentum),
               turn = matter.inverse_inertia * (at.rotation.transpose() * load.buoyancy.torque);
    return load.drag_rate + std::sqrt(load.stiffness * body.inverse_mass) + std::sqrt(turn.norm()) + spin.norm() +
           water_->wave_rate();
}

Wrench ForceField::alone(std::size_t index, const Body& body, const MassPoint& point, const Mat3& rotation,
                         double time) const {
    Wrench sum = weather(body, point.velocity);
    if (!place_.empty()) sum.force += place_.at(point, time);
    add_points(sum, index, body, rotation, [&](const ForceDescription& f) { return time >= f.start && time < f.end; });
    return sum;
}

Wrench ForceField::throughout_dry(std::size_t index, const Body& body, double from, double to) const {
    Wrench sum = dry_fields(index, body, from, to);
    add_points(sum, index, body, body.rotation, [&](const ForceDescription& f) { return covers(f, from, to); });
    return sum;
}

Wrench ForceField::throughout(std::size_t index, const Body& body, double from, double to, bool flies) const {
    Wrench sum = throughout_dry(index, body, from, to);
    if (water_) add_water(sum, index, body, from, to - from, flies);
    return sum;
}

Wrench ForceField::endless(std::size_t index, const Body& body, double from, double to) const {
    Wrench sum = fields(index, body, from, to);
    add_points(sum, index, body, body.rotation,
               [&](const ForceDescription& f) { return covers(f, from, to) && std::isinf(f.end); });
    return sum;
}

// A force's spans in successive steps are differences of the same times: they add up to its total span.
template <class Choose>
Impulse ForceField::impulse(std::size_t index, const Body& body, double from, double to, const Choose& choose) const {
    Impulse sum;
    for (const ForceDescription& f : at_points_[index]) {
        const double start = std::max(f.start, from), end = std::min(f.end, to);
        if (!(end > start) || !choose(f)) continue;
        Mat3 rotation = body.rotation;
        // a force acting throughout is evaluated at t_n, as are all forces of a step
        if (!covers(f, from, to) && !body.angular_momentum.isZero(0.0)) {
            const FreeRotation turning(body.principal_inertia, body.principal_axes, body.orientation,
                                       body.angular_momentum);
            rotation = turning.at(0.5 * (start + end) - from).toRotationMatrix();
        }
        Wrench wrench;
        add(wrench, f, body, rotation);
        sum = sum + Impulse{(end - start) * wrench.force, (end - start) * wrench.torque};
    }
    return sum;
}

Impulse ForceField::brief(std::size_t index, const Body& body, double from, double to) const {
    return impulse(index, body, from, to, [&](const ForceDescription& f) { return !covers(f, from, to); });
}

Impulse ForceField::ending(std::size_t index, const Body& body, double from, double to) const {
    return impulse(index, body, from, to, [&](const ForceDescription& f) { return !std::isinf(f.end); });
}

ForceField ForceField::without_points(std::span<const std::uint32_t> bodies) const {
    ForceField field = *this;
    for (const std::uint32_t i : bodies) field.at_points_[i].clear();
    return field;
}

bool ForceField::changes(std::size_t index, double from, double to) const {
    for (const ForceDescription& f : at_points_[index])
        if ((f.start >= from && f.start < to) || (f.end >= from && f.end < to)) return true;
    return false;
}

double ForceField::next_change(std::size_t index, double time) const {
    double next = std::numeric_limits<double>::infinity();
    for (const ForceDescription& f : at_points_[index])
        for (const double change : {f.start, f.end})
            if (change > time) next = std::min(next, change);
    if (!place_.empty()) next = std::min(next, place_.next_change(time));
    if (!pairs_.empty()) next = std::min(next, pairs_.next_change(time));
    return next;
}

bool ForceField::constant(std::size_t index, double from, double to) const {
    return plain(index) && std::none_of(at_points_[index].begin(), at_points_[index].end(),
                                        [&](const ForceDescription& f) { return f.start < to && f.end > from; });
}

bool ForceField::torque_free(std::size_t index, double time) const {
    if (pairs_.has_torques() && pairs_.turns(std::uint32_t(index), time)) return false;
    return !water_ && std::none_of(at_points_[index].begin(), at_points_[index].end(),
                                   [&](const ForceDescription& f) { return time >= f.start && time < f.end; });
}

double ForceField::drag_rate(const Body& body) const {
    return wind_ ? wind_->density * wind_->drag * body.drag_area * body.inverse_mass : 0.0;
}

}  // namespace tumble
