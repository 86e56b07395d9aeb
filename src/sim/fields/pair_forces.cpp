#include "sim/fields/pair_forces.h"

#include "core/sort_unique.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Two bodies of a force: with the line from one to the other.
struct PairOfPoints {
    std::size_t a, b;                                       // indices of their points
    double factor = 1.0;                                    // of strength and stiffness: attracts where positive
    Vec3 apart = Vec3::Zero();                              // m
    Vec3 moment_a = Vec3::Zero(), moment_b = Vec3::Zero();  // A m^2, world
    double distance = 0.0, smoothed = 0.0;                  // m
};

// On the first body, N.
Vec3 pull(const PairForceDescription& f, const PairOfPoints& p, const Vec3& parting) {
    if (f.type == PairForceKind::spring) {
        if (!(p.distance > 0.0)) return Vec3::Zero();
        const Vec3 u = p.apart / p.distance;
        return p.factor * (f.stiffness * (p.distance - f.length) + f.damping * u.dot(parting)) * u;
    }
    if (!(p.smoothed > 0.0)) return Vec3::Zero();
    return f.strength * p.factor / (p.smoothed * p.smoothed * p.smoothed) * p.apart;
}

// U = k (m1 m2 / s^3 - 3 (m1 d) (m2 d) / s^5) with d from the first dipole to the second.
double dipole_energy(const PairForceDescription& f, const PairOfPoints& p) {
    if (!(p.smoothed > 0.0)) return 0.0;
    const double s2 = p.smoothed * p.smoothed, s3 = s2 * p.smoothed;
    return f.strength / s3 *
           (p.moment_a.dot(p.moment_b) - 3.0 / s2 * p.moment_a.dot(p.apart) * p.moment_b.dot(p.apart));
}

/// The force of a dipole on the first body, the opposite of that on the second; with the torques on both.
struct DipolePull {
    Vec3 force, torque_a, torque_b;
};

// F = dU/dd, and m x B with the field B = k (3 d (m d) / s^5 - m / s^3) of the other: together they keep momentum and
// angular momentum.
DipolePull dipole_pull(const PairForceDescription& f, const PairOfPoints& p) {
    if (!(p.smoothed > 0.0)) return {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    const Vec3 &a = p.moment_a, &b = p.moment_b, &d = p.apart;
    const double s2 = p.smoothed * p.smoothed, k = f.strength / (s2 * p.smoothed), ad = a.dot(d), bd = b.dot(d);
    const Vec3 at_a = k * (3.0 * bd / s2 * d - b), at_b = k * (3.0 * ad / s2 * d - a);
    return {3.0 * k / s2 * ((5.0 * ad * bd / s2 - a.dot(b)) * d - bd * a - ad * b), a.cross(at_a), b.cross(at_b)};
}

bool acts(const PairForceDescription& f, double time) { return time >= f.start && time < f.end; }

}  // namespace

PairForces::PairForces(const std::vector<PairForceDescription>& forces, std::span<const std::size_t> place)
    : given_(forces) {
    for (PairForceDescription& f : given_)
        for (std::size_t& body : f.bodies) body = place[body];
    break_up({});
}

void PairForces::break_up(std::span<const BodyInPieces> broken) {
    bodies_.clear();
    forces_.clear();
    magnets_.clear();
    for (const PairForceDescription& given : given_) {
        Force f{given, {}, {}};
        f.bodies.clear();
        f.charges.clear();
        f.moments.clear();
        for (std::size_t i = 0; i < given.bodies.size(); ++i) {
            const auto body = std::uint32_t(given.bodies[i]);
            const std::vector<BodyInPieces::Piece> unbroken{{body, 1.0}};
            const auto found = std::ranges::find(broken, body, &BodyInPieces::whole);
            for (const BodyInPieces::Piece& piece : found != broken.end() ? found->pieces : unbroken) {
                f.bodies.push_back(piece.body);
                f.wholes.push_back(body);
                f.shares.push_back(piece.share);
                if (!given.charges.empty()) f.charges.push_back(piece.share * given.charges[i]);
                if (!given.moments.empty()) f.moments.emplace_back(piece.share * given.moments[i]);
                bodies_.push_back(piece.body);
                if (f.type == PairForceKind::dipole) magnets_.push_back(piece.body);
            }
        }
        forces_.push_back(std::move(f));
    }
    sort_unique(bodies_);
    sort_unique(magnets_);
    for (Force& f : forces_)
        for (std::size_t& body : f.bodies)
            body = std::size_t(std::lower_bound(bodies_.begin(), bodies_.end(), std::uint32_t(body)) - bodies_.begin());
}

bool PairForces::has(std::uint32_t body) const { return std::binary_search(bodies_.begin(), bodies_.end(), body); }

bool PairForces::turns(std::uint32_t body, double time) const {
    if (!std::binary_search(magnets_.begin(), magnets_.end(), body)) return false;
    return std::any_of(forces_.begin(), forces_.end(), [&](const Force& f) {
        return f.type == PairForceKind::dipole && acts(f, time) &&
               std::any_of(f.bodies.begin(), f.bodies.end(), [&](std::size_t k) { return bodies_[k] == body; });
    });
}

template <class Use>
void PairForces::each_pair(const Force& f, const PairBodies& bodies, const Use& use) const {
    const std::span<const MassPoint> points = bodies.points;
    for (std::size_t i = 0; i < f.bodies.size(); ++i)
        for (std::size_t k = i + 1; k < f.bodies.size(); ++k) {
            PairOfPoints p{f.bodies[i], f.bodies[k]};
            if (f.wholes[i] == f.wholes[k] || !(points[p.a].mass > 0.0 && points[p.b].mass > 0.0)) continue;
            p.apart = points[p.b].position - points[p.a].position;
            const double square = p.apart.squaredNorm();
            p.distance = std::sqrt(square);
            p.smoothed = std::sqrt(square + f.softening * f.softening);
            if (f.type == PairForceKind::inverse_square || f.type == PairForceKind::spring)
                p.factor = f.shares[i] * f.shares[k];
            if (f.type == PairForceKind::gravity) p.factor = points[p.a].mass * points[p.b].mass;
            if (f.type == PairForceKind::coulomb) p.factor = -f.charges[i] * f.charges[k];
            if (f.type == PairForceKind::dipole) {
                p.moment_a = bodies.turns[p.a].rotation * f.moments[i];
                p.moment_b = bodies.turns[p.b].rotation * f.moments[k];
            }
            use(p);
        }
}

void PairForces::add(const PairBodies& bodies, double time, std::span<Wrench> wrenches) const {
    add_mean(bodies, time, time, wrenches);
}

void PairForces::add_mean(const PairBodies& bodies, double from, double to, std::span<Wrench> wrenches) const {
    const std::span<const MassPoint> points = bodies.points;
    for (const Force& f : forces_) {
        double share = acts(f, from) ? 1.0 : 0.0;
        if (to > from && !(f.start <= from && f.end >= to))
            share = std::max(0.0, std::min(to, f.end) - std::max(from, f.start)) / (to - from);
        if (share == 0.0) continue;
        if (f.type == PairForceKind::dipole) {
            each_pair(f, bodies, [&](const PairOfPoints& p) {
                const DipolePull pull = dipole_pull(f, p);
                wrenches[p.a].force += share * pull.force;
                wrenches[p.b].force -= share * pull.force;
                wrenches[p.a].torque += share * pull.torque_a;
                wrenches[p.b].torque += share * pull.torque_b;
            });
            continue;
        }
        each_pair(f, bodies, [&](const PairOfPoints& p) {
            const Vec3 force = share * pull(f, p, points[p.b].velocity - points[p.a].velocity);
            wrenches[p.a].force += force;
            wrenches[p.b].force -= force;
        });
    }
}

double PairForces::rate(const PairBodies& bodies, double time) const {
    const std::span<const MassPoint> points = bodies.points;
    double fastest = 0.0;
    for (const Force& f : forces_) {
        if (!acts(f, time)) continue;
        each_pair(f, bodies, [&](const PairOfPoints& p) {
            const auto gives = [&](std::size_t k) { return points[k].mass < infinity ? 1.0 / points[k].mass : 0.0; };
            const double inverse = gives(p.a) + gives(p.b), d = std::max(p.smoothed, p.distance);
            const double parting = (points[p.b].velocity - points[p.a].velocity).norm();
            double stiffness = p.factor * f.stiffness, damping = p.factor * f.damping, turning = 0.0;
            if (f.type != PairForceKind::spring) {
                if (!(d > 0.0)) return;
                stiffness = std::abs(f.strength * p.factor) / (d * d * d);
                damping = 0.0;
            }
            if (f.type == PairForceKind::dipole) {
                // The most, of two dipoles in line: d2U/dd2 = 24 k m1 m2 / d^5, torque per angle 2 k m1 m2 / d^3.
                stiffness *= p.moment_a.norm() * p.moment_b.norm();
                turning = 2.0 * stiffness * (bodies.turns[p.a].inverse_inertia + bodies.turns[p.b].inverse_inertia);
                stiffness *= 24.0 / (d * d);
            }
            const double passes = d > 0.0 ? parting / d : 0.0;
            fastest = std::max(fastest, std::sqrt(stiffness * inverse + turning) + damping * inverse + passes);
        });
    }
    return fastest;
}

double PairForces::next_change(double time) const {
    double next = infinity;
    for (const Force& f : forces_)
        for (const double change : {f.start, f.end})
            if (change > time) next = std::min(next, change);
    return next;
}

double PairForces::potential(const PairBodies& bodies) const {
    double sum = 0.0;
    for (const Force& f : forces_) {
        if (f.start > 0.0 || f.end < infinity) continue;
        each_pair(f, bodies, [&](const PairOfPoints& p) {
            if (f.type == PairForceKind::dipole)
                sum += dipole_energy(f, p);
            else if (f.type == PairForceKind::spring)
                sum += 0.5 * p.factor * f.stiffness * (p.distance - f.length) * (p.distance - f.length);
            else if (p.smoothed > 0.0)
                sum -= f.strength * p.factor / p.smoothed;
        });
    }
    return sum;
}

}  // namespace tumble
