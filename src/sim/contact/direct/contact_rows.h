// A manifold as rows of the Jacobian J over the velocities of an island: up to four normals, two friction directions,
// one torsional friction. u holds six numbers per body: velocity, and the length (m) times angular velocity.
#pragma once

#include "sim/contact/model/contact_areas.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/model/rotational_friction.h"
#include "sim/dynamics/body.h"

#include <algorithm>
#include <cstdint>
#include <span>
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
struct ConstraintRows {
    int a = none, b = none, pair = none, count = 0;
    std::uint32_t manifold = 0;
    Row normal[4], friction[2], torsion;
    double lever[4] = {}, overlap[4] = {};  // m
    double rebound[4] = {};                 // m/s, of points that bounce in an island with joints
    double coefficient = 0.0, limit = 0.0, torsion_limit = 0.0, size = 0.0;
    double last_limits[2] = {};  // N s, of the rounds before, the later one first
    double spin_lever = 0.0;     // m, of torsional friction that shares the friction limit
    double free_slip = 0.0, free_spin = 0.0, torsion_mass = 0.0;  // m/s and rad/s after the forces alone; kg m^2
    bool spins = false;  // the spin is faster than torsional friction can stop: it shares the friction limit
    Vec3 tangent_1 = Vec3::Zero();
    std::uint8_t source[4] = {};
    ContactConstraint geometry;
    // Shared area: its first constraint has the friction rows of all; the others do not rub.
    const SharedArea* area = nullptr;
    int first = none, next = none;  // indices of constraints: the first, and a chain from it through all others
    bool rubs = true;
    double area_load = 0.0;  // N s, of the first: sum of all loads times their coefficients
    int resistance = none;   // index of its ResistanceRows
};
/// Rolling and spinning friction of a constraint (rotational_friction.h).
struct ResistanceRows {
    int constraint = none;
    RotationalFriction levers;
    Row rolling[2], spinning;                          // N m s, across the normal along both tangents, and about it
    double rolling_limit = 0.0, spinning_limit = 0.0;  // N m s
    double weights[3][3] = {};                         // second derivatives

    Row& row(int i) { return i < 2 ? rolling[i] : spinning; }
    const Row& row(int i) const { return i < 2 ? rolling[i] : spinning; }
};

/// Index of a body among the island's, ascending; none if it is not one of them.
inline int place_of(std::span<const std::uint32_t> bodies, std::uint32_t body) {
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), body);
    return found != bodies.end() && *found == body ? int(found - bodies.begin()) : none;
}

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

/// Bodies of the rows of `constraint`, and the length (m) that scales angular velocities.
struct RowBodies {
    const ConstraintRows& constraint;
    const Body &a, &b;
    double length;
};

/// A row: direction . (velocity of B's point - that of A's point).
inline void set_row(Row& row, const Vec3& direction, const Vec3& arm_a, const Vec3& arm_b, const RowBodies& bodies) {
    const auto& [constraint, a, b, length] = bodies;
    if (constraint.a != none)
        put(row.on_a, -direction, -arm_a.cross(direction) / length);
    else if (a.moves())
        row.offset -= direction.dot(a.point_velocity(arm_a));
    if (constraint.b != none)
        put(row.on_b, direction, arm_b.cross(direction) / length);
    else if (b.moves())
        row.offset += direction.dot(b.point_velocity(arm_b));
}
/// A row of a turn: direction . (angular velocity of B - that of A).
inline void set_turn(Row& row, const Vec3& direction, const RowBodies& bodies) {
    const auto& [constraint, a, b, length] = bodies;
    if (constraint.a != none)
        put(row.on_a, Vec3::Zero(), -direction / length);
    else if (a.moves())
        row.offset -= direction.dot(a.angular_velocity);
    if (constraint.b != none)
        put(row.on_b, Vec3::Zero(), direction / length);
    else if (b.moves())
        row.offset += direction.dot(b.angular_velocity);
}

/// J u of one row.
inline double dot(const ConstraintRows& constraint, const Row& row, const std::vector<double>& u) {
    double sum = 0.0;
    if (constraint.a != none)
        for (int k = 0; k < 6; ++k) sum += row.on_a[k] * u[std::size_t(6 * constraint.a + k)];
    if (constraint.b != none)
        for (int k = 0; k < 6; ++k) sum += row.on_b[k] * u[std::size_t(6 * constraint.b + k)];
    return sum;
}
/// Adds amount J^T of one row.
inline void add(const ConstraintRows& constraint, const Row& row, double amount, std::vector<double>& to) {
    if (constraint.a != none)
        for (int k = 0; k < 6; ++k) to[std::size_t(6 * constraint.a + k)] += amount * row.on_a[k];
    if (constraint.b != none)
        for (int k = 0; k < 6; ++k) to[std::size_t(6 * constraint.b + k)] += amount * row.on_b[k];
}

template <class Visit>
void each_row(ConstraintRows& constraint, Visit&& visit) {
    for (int i = 0; i < constraint.count; ++i) visit(constraint.normal[i]);
    if (!constraint.rubs) return;
    visit(constraint.friction[0]);
    visit(constraint.friction[1]);
    if (constraint.count > 1) visit(constraint.torsion);
}

}  // namespace tumble::contact_rows
