// One linear form of the mass-weighted velocities of a cluster of bodies.
//
// A body's mass-weighted velocity is y = (M^1/2 v, C^-1 omega) with C C^T = I^-1. In y the kinetic energy is |y|^2 / 2,
// so the least change of motion is the least distance, and the impulse along a form moves y along the form itself,
// independent of the masses. v = M^-1/2 y_1..3, omega = C y_4..6.
#pragma once

#include "core/vector.h"

#include <cstdint>

namespace tumble {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// w . y over at most two bodies; a body that is not dynamic has no entry in y.
struct VelocityRow {
    static constexpr std::uint32_t none = UINT32_MAX;
    std::uint32_t a = none, b = none;  // positions of the bodies in y, six numbers each
    Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();

    double dot(const Eigen::VectorXd& y) const {
        double sum = 0.0;
        if (a != none) sum += on_a.dot(y.segment<6>(6 * Eigen::Index(a)));
        if (b != none) sum += on_b.dot(y.segment<6>(6 * Eigen::Index(b)));
        return sum;
    }
    double dot(const VelocityRow& other) const {
        double sum = 0.0;
        if (a != none && a == other.a) sum += on_a.dot(other.on_a);
        if (a != none && a == other.b) sum += on_a.dot(other.on_b);
        if (b != none && b == other.a) sum += on_b.dot(other.on_a);
        if (b != none && b == other.b) sum += on_b.dot(other.on_b);
        return sum;
    }
    void add_to(Eigen::VectorXd& y, double amount) const {
        if (a != none) y.segment<6>(6 * Eigen::Index(a)) += amount * on_a;
        if (b != none) y.segment<6>(6 * Eigen::Index(b)) += amount * on_b;
    }
    double squared_norm() const { return on_a.squaredNorm() + on_b.squaredNorm(); }
};

}  // namespace tumble
