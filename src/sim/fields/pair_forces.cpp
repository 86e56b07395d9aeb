#include "sim/fields/pair_forces.h"

#include "core/sort_unique.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Two bodies of a force: with the line from one to the other.
struct PairOfPoints {
    std::size_t a, b;                       // indices of their points
    double factor = 0.0;                    // of the strength: attracts where positive
    Vec3 apart;                             // m
    double distance = 0.0, smoothed = 0.0;  // m
};

// On the first body, N.
Vec3 pull(const PairForceDescription& f, const PairOfPoints& p, const Vec3& parting) {
    if (f.type == PairForceKind::spring) {
        if (!(p.distance > 0.0)) return Vec3::Zero();
        const Vec3 u = p.apart / p.distance;
        return (f.stiffness * (p.distance - f.length) + f.damping * u.dot(parting)) * u;
    }
    if (!(p.smoothed > 0.0)) return Vec3::Zero();
    return f.strength * p.factor / (p.smoothed * p.smoothed * p.smoothed) * p.apart;
}

bool acts(const PairForceDescription& f, double time) { return time >= f.start && time < f.end; }

}  // namespace

PairForces::PairForces(const std::vector<PairForceDescription>& forces, std::span<const std::size_t> place)
    : forces_(forces) {
    for (const PairForceDescription& f : forces_)
        for (const std::size_t body : f.bodies) bodies_.push_back(std::uint32_t(place[body]));
    sort_unique(bodies_);
    for (PairForceDescription& f : forces_)
        for (std::size_t& body : f.bodies)
            body = std::size_t(std::lower_bound(bodies_.begin(), bodies_.end(), place[body]) - bodies_.begin());
}

bool PairForces::has(std::uint32_t body) const { return std::binary_search(bodies_.begin(), bodies_.end(), body); }

template <class Use>
void PairForces::each_pair(const PairForceDescription& f, std::span<const MassPoint> points, const Use& use) const {
    for (std::size_t i = 0; i < f.bodies.size(); ++i)
        for (std::size_t k = i + 1; k < f.bodies.size(); ++k) {
            PairOfPoints p{f.bodies[i], f.bodies[k], 1.0, Vec3::Zero()};
            p.apart = points[p.b].position - points[p.a].position;
            const double square = p.apart.squaredNorm();
            p.distance = std::sqrt(square);
            p.smoothed = std::sqrt(square + f.softening * f.softening);
            if (f.type == PairForceKind::gravity) p.factor = points[p.a].mass * points[p.b].mass;
            if (f.type == PairForceKind::coulomb) p.factor = -f.charges[i] * f.charges[k];
            use(p);
        }
}

void PairForces::add(std::span<const MassPoint> points, double time, std::span<Vec3> forces) const {
    add_mean(points, time, time, forces);
}

void PairForces::add_mean(std::span<const MassPoint> points, double from, double to, std::span<Vec3> forces) const {
    for (const PairForceDescription& f : forces_) {
        double share = acts(f, from) ? 1.0 : 0.0;
        if (to > from && !(f.start <= from && f.end >= to))
            share = std::max(0.0, std::min(to, f.end) - std::max(from, f.start)) / (to - from);
        if (share == 0.0) continue;
        each_pair(f, points, [&](const PairOfPoints& p) {
            const Vec3 force = share * pull(f, p, points[p.b].velocity - points[p.a].velocity);
            forces[p.a] += force;
            forces[p.b] -= force;
        });
    }
}

double PairForces::rate(std::span<const MassPoint> points, double time) const {
    double fastest = 0.0;
    for (const PairForceDescription& f : forces_) {
        if (!acts(f, time)) continue;
        each_pair(f, points, [&](const PairOfPoints& p) {
            const auto gives = [&](std::size_t k) { return points[k].mass < infinity ? 1.0 / points[k].mass : 0.0; };
            const double inverse = gives(p.a) + gives(p.b), d = std::max(p.smoothed, p.distance);
            const double parting = (points[p.b].velocity - points[p.a].velocity).norm();
            double stiffness = f.stiffness, damping = f.damping;
            if (f.type != PairForceKind::spring) {
                if (!(d > 0.0)) return;
                stiffness = std::abs(f.strength * p.factor) / (d * d * d);
                damping = 0.0;
            }
            const double passes = d > 0.0 ? parting / d : 0.0;
            fastest = std::max(fastest, std::sqrt(stiffness * inverse) + damping * inverse + passes);
        });
    }
    return fastest;
}

double PairForces::next_change(double time) const {
    double next = infinity;
    for (const PairForceDescription& f : forces_)
        for (const double change : {f.start, f.end})
            if (change > time) next = std::min(next, change);
    return next;
}

double PairForces::potential(std::span<const MassPoint> points) const {
    double sum = 0.0;
    for (const PairForceDescription& f : forces_) {
        if (f.start > 0.0 || f.end < infinity) continue;
        each_pair(f, points, [&](const PairOfPoints& p) {
            if (f.type == PairForceKind::spring)
                sum += 0.5 * f.stiffness * (p.distance - f.length) * (p.distance - f.length);
            else if (p.smoothed > 0.0)
                sum -= f.strength * p.factor / p.smoothed;
        });
    }
    return sum;
}

}  // namespace tumble
