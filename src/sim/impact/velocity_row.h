// One linear form of the mass-weighted velocities of a cluster of bodies.
//
// A body's mass-weighted velocity is y = (M^1/2 v, C^-1 omega) with C C^T = I^-1. In y the kinetic energy is |y|^2 / 2,
// so the least change of motion is the least distance, and the impulse along a form moves y along the form itself,
// independent of the masses. v = M^-1/2 y_1..3, omega = C y_4..6.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// A form over groups of joined bodies: an impulse on one of them moves all bodies of its group.
struct JoinedRow {
    std::uint32_t bodies_a = 0, bodies_b = 0;  // number of bodies from indices a and b of the row on
    std::uint32_t own = 0;                     // index in ImpactSystem: the form of the struck bodies alone
    double sign = 1.0;
    std::vector<double> numbers;  // six for each body, of the first body

    std::span<const double> on_a() const { return std::span(numbers).first(6 * std::size_t(bodies_a)); }
    std::span<const double> on_b() const { return std::span(numbers).subspan(6 * std::size_t(bodies_a)); }
};

/// w . y over at most two bodies, or two groups of joined bodies; a body that is not dynamic has no entry in y.
struct VelocityRow {
    static constexpr std::uint32_t none = UINT32_MAX;
    std::uint32_t a = none, b = none;   // indices of the bodies in y, six numbers each; of a group: of its first body
    const JoinedRow* joined = nullptr;  // instead of on_a and on_b
    Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();

    std::uint32_t bodies_a() const { return joined ? joined->bodies_a : 1; }
    std::uint32_t bodies_b() const { return joined ? joined->bodies_b : 1; }

    template <class Velocity>
    double dot(const Velocity& y) const {
        if (joined) [[unlikely]]
            return joined_dot(y);
        double sum = 0.0;
        if (a != none) sum += on_a.dot(y.template segment<6>(6 * Eigen::Index(a)));
        if (b != none) sum += on_b.dot(y.template segment<6>(6 * Eigen::Index(b)));
        return sum;
    }
    double dot(const VelocityRow& other) const {
        if (joined || other.joined) [[unlikely]]
            return joined_dot(other);
        double sum = 0.0;
        if (a != none && a == other.a) sum += on_a.dot(other.on_a);
        if (a != none && a == other.b) sum += on_a.dot(other.on_b);
        if (b != none && b == other.a) sum += on_b.dot(other.on_a);
        if (b != none && b == other.b) sum += on_b.dot(other.on_b);
        return sum;
    }
    void add_to(Eigen::VectorXd& y, double amount) const {
        if (joined) [[unlikely]]
            return joined_add_to(y, amount);
        if (a != none) y.segment<6>(6 * Eigen::Index(a)) += amount * on_a;
        if (b != none) y.segment<6>(6 * Eigen::Index(b)) += amount * on_b;
    }
    double squared_norm() const { return joined ? joined_norm() : on_a.squaredNorm() + on_b.squaredNorm(); }

private:
    template <class Velocity>
    double joined_dot(const Velocity& y) const {
        double sum = 0.0;
        if (a != none) sum += product(joined->on_a(), y.data() + 6 * std::size_t(a));
        if (b != none) sum += product(joined->on_b(), y.data() + 6 * std::size_t(b));
        return joined->sign * sum;
    }
    static double product(std::span<const double> numbers, const double* y);
    double joined_dot(const VelocityRow& other) const;
    double joined_norm() const;
    void joined_add_to(Eigen::VectorXd& y, double amount) const;
};

}  // namespace tumble
