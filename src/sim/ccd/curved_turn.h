// A rotation that changes its speed and axis: the rotation vector from its start is cubic in time (Hermite), through the
// orientations and angular velocities of both ends. Error O(span^4) in between.
#pragma once

#include "core/vector.h"

#include <optional>

namespace tumble {

struct CurvedTurn {
    Quat from = Quat::Identity();
    Vec3 rate = Vec3::Zero(), bend = Vec3::Zero(), twist = Vec3::Zero();  // derivatives of the rotation vector at 0

    struct End {
        Quat orientation;
        Vec3 angular_velocity;  // rad/s
    };
    /// Between two ends `span` s apart; none where the rotation is too large for one vector.
    static std::optional<CurvedTurn> between(const End& start, const End& end, double span);

    Vec3 vector(double t) const { return t * (rate + t * (0.5 * bend + t / 6.0 * twist)); }
    Vec3 vector_rate(double t) const { return rate + t * (bend + 0.5 * t * twist); }
    Quat orientation(double t) const;
    Vec3 angular_velocity(double t) const;

    /// Upper bounds up to time `span`: of |omega| (rad/s), and of |omega|^2 + |alpha| (rad/s^2).
    double spin_bound(double span) const;
    double turning_bound(double span) const;

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [from, rate, bend, twist] = self;
        archive.keep(from, rate, bend, twist);
    }
};

}  // namespace tumble
