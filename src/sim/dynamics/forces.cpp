#include "sim/dynamics/forces.h"

#include "core/sort_unique.h"
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

/// The bodies with forces between each other at their present places.
struct PresentPairs {
    PresentPairs(const PairForces& pairs, const std::vector<Body>& bodies) {
        for (const std::uint32_t i : pairs.bodies()) {
            const Body& body = bodies[i];
            points.push_back({body.dynamic() ? body.mass : infinity, body.position, body.velocity});
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
      held_(pairs_.bodies().size()) {
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
        const std::uint32_t body = to(force.point);
        at_points_[body].push_back(force);
        pushed_.push_back(body);
    }
    sort_unique(pushed_);
}

void ForceField::each_point(std::size_t index, double time,
                            const std::function<void(const ForceDescription&)>& use) const {
    for (const ForceDescription& f : at_points_[index])
        if (time >= f.start && time < f.end) use(f);
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
    Wrench sum = weather(body, body.velocity);
    if (!place_.empty()) sum.force += place_.mean({body.mass, body.position, body.velocity}, from, to);
    if (!pairs_.empty()) sum += held(index);
    return sum;
}

template <class Choose>
void ForceField::add_points(Wrench& sum, std::size_t index, const Body& body, const Mat3& rotation,
                            const Choose& choose) const {
    for (const ForceDescription& f : at_points_[index])
        if (choose(f)) add(sum, f, body, rotation);
}

Wrench ForceField::at(std::size_t index, const Body& body, const Vec3& position, const Vec3& velocity,
                      const Mat3& rotation, double time) const {
    Wrench sum = alone(index, body, position, velocity, rotation, time);
    if (!pairs_.empty()) sum += held(index);
    return sum;
}

Wrench ForceField::alone(std::size_t index, const Body& body, const Vec3& position, const Vec3& velocity,
                         const Mat3& rotation, double time) const {
    Wrench sum = weather(body, velocity);
    if (!place_.empty()) sum.force += place_.at({body.mass, position, velocity}, time);
    add_points(sum, index, body, rotation, [&](const ForceDescription& f) { return time >= f.start && time < f.end; });
    return sum;
}

Wrench ForceField::throughout(std::size_t index, const Body& body, double from, double to) const {
    Wrench sum = fields(index, body, from, to);
    add_points(sum, index, body, body.rotation, [&](const ForceDescription& f) { return covers(f, from, to); });
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

ForceField ForceField::without_points() const {
    ForceField field = *this;
    field.pushed_.clear();
    field.explosions_ = {};
    for (auto& list : field.at_points_) list.clear();
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
    return std::none_of(at_points_[index].begin(), at_points_[index].end(),
                        [&](const ForceDescription& f) { return time >= f.start && time < f.end; });
}

double ForceField::drag_rate(const Body& body) const {
    return wind_ ? wind_->density * wind_->drag * body.drag_area * body.inverse_mass : 0.0;
}

}  // namespace tumble
