// A manifold as rows of the Jacobian J over the velocities of an island: up to four normals, two friction directions,
// one torsional friction. u holds six numbers per body: velocity, and the length (m) times angular velocity.
#pragma once

#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/body.h"

#include <cstdint>
#include <vector>

namespace tumble::contact_rows {

inline constexpr int none = -1;  // index of a body that is not a dynamic body of the island

struct Row {  // a row of J and its scalars
    double on_a[6] = {}, on_b[6] = {};
    double offset = 0.0;                   // m/s, contribution of bodies with prescribed velocity
    double target = 0.0;                   // m/s: b in direct_solver.h
    double estimate = 0.0, impulse = 0.0;  // N s: e and f in direct_solver.h
    double speed = 0.0, change = 0.0;      // J u + offset, J du
};
struct Patch {
    int a = none, b = none, pair = none, count = 0;
    std::uint32_t manifold = 0;
    Row normal[4], friction[2], twist;
    double lever[4] = {}, overlap[4] = {};  // m
    double coefficient = 0.0, limit = 0.0, twist_limit = 0.0, size = 0.0;
    double spin_lever = 0.0;  // m, of torsional friction that shares the friction limit
    double free_slip = 0.0, free_spin = 0.0, twist_mass = 0.0;  // m/s and rad/s after the forces alone; kg m^2
    bool spins = false;  // the spin is faster than torsional friction can stop: it shares the friction limit
    Vec3 tangent_1 = Vec3::Zero();
    std::uint8_t source[4] = {};
    ContactConstraint geometry;
};

/// Three of the numbers, from an index on.
inline Eigen::Map<Vec3> three(std::vector<double>& numbers, std::size_t from) {
    return Eigen::Map<Vec3>(numbers.data() + from);
}
inline Eigen::Map<const Vec3> three(const std::vector<double>& numbers, std::size_t from) {
    return Eigen::Map<const Vec3>(numbers.data() + from);
}

/// Writes the six numbers of a body.
inline void put(double* six, const Vec3& linear, const Vec3& angular) {
    for (int k = 0; k < 3; ++k) {
        six[k] = linear[k];
        six[3 + k] = angular[k];
    }
}

/// Bodies of the rows of `patch`, and the length (m) that scales angular velocities.
struct RowBodies {
    const Patch& patch;
    const Body &a, &b;
    double length;
};

/// A row: direction . (velocity of B's point - that of A's point).
inline void set_row(Row& row, const Vec3& direction, const Vec3& arm_a, const Vec3& arm_b, const RowBodies& bodies) {
    const auto& [patch, a, b, length] = bodies;
    if (patch.a != none)
        put(row.on_a, -direction, -arm_a.cross(direction) / length);
    else if (a.moves())
        row.offset -= direction.dot(a.point_velocity(arm_a));
    if (patch.b != none)
        put(row.on_b, direction, arm_b.cross(direction) / length);
    else if (b.moves())
        row.offset += direction.dot(b.point_velocity(arm_b));
}
/// The torsional row: normal . (angular velocity of B - that of A).
inline void set_twist(Row& row, const Vec3& normal, const RowBodies& bodies) {
    const auto& [patch, a, b, length] = bodies;
    if (patch.a != none)
        put(row.on_a, Vec3::Zero(), -normal / length);
    else if (a.moves())
        row.offset -= normal.dot(a.angular_velocity);
    if (patch.b != none)
        put(row.on_b, Vec3::Zero(), normal / length);
    else if (b.moves())
        row.offset += normal.dot(b.angular_velocity);
}

/// J u of one row.
inline double dot(const Patch& patch, const Row& row, const std::vector<double>& u) {
    double sum = 0.0;
    if (patch.a != none)
        for (int k = 0; k < 6; ++k) sum += row.on_a[k] * u[std::size_t(6 * patch.a + k)];
    if (patch.b != none)
        for (int k = 0; k < 6; ++k) sum += row.on_b[k] * u[std::size_t(6 * patch.b + k)];
    return sum;
}
/// Adds amount J^T of one row.
inline void add(const Patch& patch, const Row& row, double amount, std::vector<double>& to) {
    if (patch.a != none)
        for (int k = 0; k < 6; ++k) to[std::size_t(6 * patch.a + k)] += amount * row.on_a[k];
    if (patch.b != none)
        for (int k = 0; k < 6; ++k) to[std::size_t(6 * patch.b + k)] += amount * row.on_b[k];
}

template <class Visit>
void each_row(Patch& patch, Visit&& visit) {
    for (int i = 0; i < patch.count; ++i) visit(patch.normal[i]);
    visit(patch.friction[0]);
    visit(patch.friction[1]);
    if (patch.count > 1) visit(patch.twist);
}

}  // namespace tumble::contact_rows
