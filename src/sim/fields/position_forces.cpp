#include "sim/fields/position_forces.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// The length of r with the softening, m.
double smoothed(const Vec3& r, double softening) { return std::sqrt(r.squaredNorm() + softening * softening); }

Vec3 force_of(const FieldDescription& f, const MassPoint& body) {
    const Vec3 r = body.position - f.center;
    switch (f.type) {
        case FieldKind::uniform:
            return body.mass * f.acceleration;
        case FieldKind::point: {
            const double d = smoothed(r, f.softening);
            if (!(d > 0.0)) return Vec3::Zero();
            return -body.mass * f.strength / (d * d * d) * r;
        }
        case FieldKind::vortex: {
            const Vec3 around = f.axis.cross(r);
            const double d = smoothed(around, f.softening);
            if (!(d > 0.0)) return Vec3::Zero();
            return body.mass * f.strength / (d * d) * around;
        }
        case FieldKind::drag: {
            const Vec3 u = f.velocity - body.velocity;
            return (f.linear + f.quadratic * u.norm()) * u;
        }
    }
    return Vec3::Zero();
}

// How fast a body loses its speed, 1/s.
double drag_rate_of(const FieldDescription& f, const MassPoint& body) {
    if (f.type != FieldKind::drag) return 0.0;
    return (f.linear + 2.0 * f.quadratic * (f.velocity - body.velocity).norm()) / body.mass;
}

// How fast a body circles or passes the center, 1/s.
double passing_rate_of(const FieldDescription& f, const MassPoint& body) {
    if (f.type == FieldKind::drag || f.type == FieldKind::uniform) return 0.0;
    const Vec3 r = body.position - f.center;
    const double d = smoothed(f.type == FieldKind::vortex ? Vec3(f.axis.cross(r)) : r, f.softening);
    if (!(d > 0.0)) return 0.0;
    const double power = f.type == FieldKind::point ? d * d * d : d * d;
    return std::sqrt(std::abs(f.strength) / power) + body.velocity.norm() / d;
}

bool lasts(const FieldDescription& f) {
    return f.region.kind == RegionKind::all && f.start <= 0.0 && f.end == infinity;
}

}  // namespace

PositionForces::PositionForces(const std::vector<FieldDescription>& fields, const Vec3& origin) : fields_(fields) {
    for (FieldDescription& f : fields_) {
        f.center -= origin;
        f.region.center -= origin;
    }
}

Vec3 PositionForces::at(const MassPoint& body, double time) const {
    Vec3 sum = Vec3::Zero();
    for (const FieldDescription& f : fields_)
        if (time >= f.start && time < f.end && f.region.contains(body.position)) sum += force_of(f, body);
    return sum;
}

Vec3 PositionForces::mean(const MassPoint& body, double from, double to) const {
    Vec3 sum = Vec3::Zero();
    for (const FieldDescription& f : fields_) {
        const double acts = std::min(to, f.end) - std::max(from, f.start);
        if (!(acts > 0.0) || !f.region.contains(body.position)) continue;
        sum += (f.start <= from && f.end >= to ? 1.0 : acts / (to - from)) * force_of(f, body);
    }
    return sum;
}

template <class Rate>
double PositionForces::fastest(const MassPoint& body, double time, const Rate& rate) const {
    double most = 0.0;
    for (const FieldDescription& f : fields_)
        if (time >= f.start && time < f.end && f.region.contains(body.position)) most = std::max(most, rate(f, body));
    return most;
}

double PositionForces::rate(const MassPoint& body, double time) const {
    return std::max(fastest(body, time, drag_rate_of), passing_rate(body, time));
}

double PositionForces::passing_rate(const MassPoint& body, double time) const {
    return fastest(body, time, passing_rate_of);
}

bool PositionForces::changes(double from, double to) const {
    return std::any_of(fields_.begin(), fields_.end(), [&](const FieldDescription& f) {
        return (f.start >= from && f.start < to) || (f.end >= from && f.end < to);
    });
}

double PositionForces::next_change(double time) const {
    double next = infinity;
    for (const FieldDescription& f : fields_)
        for (const double change : {f.start, f.end})
            if (change > time) next = std::min(next, change);
    return next;
}

double PositionForces::potential(const MassPoint& body) const {
    double sum = 0.0;
    for (const FieldDescription& f : fields_) {
        if (!lasts(f)) continue;
        if (f.type == FieldKind::uniform) sum -= body.mass * f.acceleration.dot(body.position - f.center);
        if (f.type != FieldKind::point) continue;
        const double d = smoothed(body.position - f.center, f.softening);
        if (d > 0.0) sum -= body.mass * f.strength / d;
    }
    return sum;
}

}  // namespace tumble
