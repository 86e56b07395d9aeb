// Forces of [[field]] tables on a body: they depend on its place, its velocity and the time.
#pragma once

#include "scene/description/force_fields.h"

#include <vector>

namespace tumble {

/// The center of mass of a body in motion: kg; m and m/s in the coordinates of the simulation.
struct MassPoint {
    double mass = 0.0;
    Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
};

class PositionForces {
public:
    /// `origin`: m, world, of the coordinates.
    PositionForces(const std::vector<FieldDescription>& fields, const Vec3& origin);

    bool empty() const { return fields_.empty(); }
    /// Sum of the forces at a time, N; and the mean over [from, to) for a body that stays where it is.
    Vec3 at(const MassPoint& body, double time) const;
    Vec3 mean(const MassPoint& body, double from, double to) const;
    /// Fastest rate at which the force changes the motion, 1/s; and at which a body circles or passes a center.
    double rate(const MassPoint& body, double time) const;
    double passing_rate(const MassPoint& body, double time) const;
    /// True if a field begins or ends within [from, to).
    bool changes(double from, double to) const;
    /// The first time after `time` at which a field begins or ends; infinity when there is none.
    double next_change(double time) const;

    /// J, of the fields that have a potential and act everywhere at all times.
    double potential(const MassPoint& body) const;

private:
    template <class Rate>
    double fastest(const MassPoint& body, double time, const Rate& rate) const;

    std::vector<FieldDescription> fields_;
};

}  // namespace tumble
