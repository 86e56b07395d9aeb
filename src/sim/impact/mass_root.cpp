#include "sim/impact/mass_root.h"

#include <cmath>

namespace tumble {
namespace {

// Lower Cholesky factor; a direction without compliance (a nonpositive pivot) gets a column of zeros.
Mat3 cholesky(const Mat3& m) {
    Mat3 g = Mat3::Zero();
    for (int j = 0; j < 3; ++j) {
        double pivot = m(j, j);
        for (int k = 0; k < j; ++k) pivot -= g(j, k) * g(j, k);
        if (!(pivot > 0.0)) continue;
        g(j, j) = std::sqrt(pivot);
        for (int i = j + 1; i < 3; ++i) {
            double sum = m(i, j);
            for (int k = 0; k < j; ++k) sum -= g(i, k) * g(j, k);
            g(i, j) = sum / g(j, j);
        }
    }
    return g;
}

}  // namespace

MassRoot::MassRoot(const Body& body)
    : translation(std::sqrt(body.inverse_mass)), turn(body.rotation * cholesky(body.inverse_inertia_body)) {}

Vec6 MassRoot::row(const Vec3& arm, const Vec3& direction) const {
    Vec6 w;
    w << translation * direction, turn.transpose() * arm.cross(direction);
    return w;
}

Vec6 MassRoot::turning_row(const Vec3& direction) const {
    Vec6 w;
    w << Vec3::Zero(), turn.transpose() * direction;
    return w;
}

Vec6 MassRoot::weighted(const Body& body) const {
    // omega = R G y with G lower: forward substitution.
    const Mat3 g = body.rotation.transpose() * turn;
    const Vec3 spin = body.rotation.transpose() * body.angular_velocity;
    Vec6 y;
    y.head<3>() = translation > 0.0 ? Vec3(body.velocity / translation) : Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        double sum = spin[i];
        for (int k = 0; k < i; ++k) sum -= g(i, k) * y[3 + k];
        y[3 + i] = g(i, i) > 0.0 ? sum / g(i, i) : 0.0;
    }
    return y;
}

}  // namespace tumble
