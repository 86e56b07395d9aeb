// The closed form against Taylor series of higher precision, and its invariants: L, energy, time reversal.
#include "sim/math/free_rotation.h"

#include "core/deterministic_math.h"
#include "sim/random_shapes.h"
#include "support/rotation_reference.h"

#include <gtest/gtest.h>

namespace tumble::free_rotation_test {
using namespace tumble::testing;

namespace {

__extension__ using Wide = __float128;

struct Flight {
    Vec3 inertia;
    Quat orientation = Quat::Identity();
    Vec3 angular_momentum;  // world

    static Flight spinning(const Vec3& inertia, const Vec3& body_omega, const Quat& orientation = Quat::Identity()) {
        return {inertia, orientation, orientation * inertia.cwiseProduct(body_omega)};
    }
    FreeRotation closed() const { return {inertia, Quat::Identity(), orientation, angular_momentum}; }
    Vec3 body_momentum(const Quat& q) const { return q.conjugate() * angular_momentum; }
    Vec3 body_omega(const Quat& q) const { return body_momentum(q).cwiseQuotient(inertia); }
    double spin() const { return body_omega(orientation).norm(); }

    template <class Real = long double>
    double error(double t) const {
        RotationReference<Real> reference(inertia, orientation, angular_momentum);
        reference.advance(t);
        return reference.angle_to(closed().at(t));
    }
};

double angle(const Quat& a, const Quat& b) { return 2.0 * (a.conjugate() * b).vec().norm(); }

// m . (m/I), in extended precision: the test measures the orientation, not this sum.
long double twice_energy(const Flight& f, const Quat& q) {
    const long double w = q.w(), x = q.x(), y = q.y(), z = q.z(), n = w * w + x * x + y * y + z * z;
    const long double a = f.angular_momentum.x(), b = f.angular_momentum.y(), c = f.angular_momentum.z();
    const long double m[3] = {
        ((w * w + x * x - y * y - z * z) * a + 2 * (x * y + w * z) * b + 2 * (x * z - w * y) * c) / n,
        (2 * (x * y - w * z) * a + (w * w - x * x + y * y - z * z) * b + 2 * (y * z + w * x) * c) / n,
        (2 * (x * z + w * y) * a + 2 * (y * z - w * x) * b + (w * w - x * x - y * y + z * z) * c) / n};
    long double sum = 0;
    for (int i = 0; i < 3; ++i) sum += m[i] * m[i] / f.inertia[i];
    return sum;
}

Vec3 box_inertia(double x, double y, double z) { return Vec3(y * y + z * z, z * z + x * x, x * x + y * y) / 12.0; }

// Inertia of matter: the greatest moment is at most the sum of the two others.
Vec3 random_inertia(Random& random, int kind) {
    Vec3 size(random(0.1, 1.1), random(0.1, 1.1), random(0.1, 1.1));
    const double little = std::ldexp(random(0.5, 1.0), -random.below(52));
    switch (kind % 6) {
        case 1:
            size = Vec3::Ones();
            break;  // sphere
        case 2:
            size = Vec3(1.0, 1.0 + little, 1.0 + random(-1.0, 1.0) * little);
            break;  // near a sphere
        case 3:
            size[1] = size[0];
            break;  // symmetric
        case 4:
            size[1] = size[0] * (1.0 + little);
            break;  // nearly
        default:
            break;
    }
    const Vec3 inertia = box_inertia(size.x(), size.y(), size.z());
    const int turn = random.below(3);
    return {inertia[turn], inertia[(turn + 1) % 3], inertia[(turn + 2) % 3]};
}

Vec3 random_momentum(Random& random, const Vec3& inertia, int kind) {
    Vec3 m = random.direction();
    const double little = std::ldexp(random(-1.0, 1.0), -random.below(60));
    std::array<int, 3> o{0, 1, 2};
    std::sort(o.begin(), o.end(), [&](int a, int b) { return inertia[a] < inertia[b]; });
    switch (kind % 5) {
        case 1: {  // near the separatrix: 2 T Imid = |L|^2
            const double a = (inertia[o[1]] - inertia[o[0]]) / inertia[o[0]],
                         c = (inertia[o[2]] - inertia[o[1]]) / inertia[o[2]];
            m[o[0]] = std::sqrt(c), m[o[2]] = std::sqrt(a) * (1.0 + little),
            m[o[1]] = random(-2.0, 2.0) * std::sqrt(a + c);
            break;
        }
        case 2:
            m = little * m + Vec3::Unit(random.below(3));
            break;  // near an axis
        case 3:
            m = (random(0, 1) < 0.5 ? 1.0 : -1.0) * Vec3::Unit(random.below(3));
            break;  // about an axis
        default:
            break;
    }
    return m.norm() > 0.0 ? Vec3(m.normalized()) : Vec3(Vec3::UnitX());
}

Flight random_flight(Random& random, int kind) {
    Flight f;
    f.inertia = random_inertia(random, kind);
    f.orientation = kind % 7 == 0 ? Quat::Identity() : random.turn();
    const Vec3 m = random_momentum(random, f.inertia, kind / 6);
    f.angular_momentum = f.orientation * Vec3(m / m.cwiseQuotient(f.inertia).norm());  // 1 rad/s
    return f;
}

}  // namespace

TEST(FreeRotationReference, SameInExtendedAndQuadruplePrecision) {
    const Flight f = Flight::spinning(box_inertia(1.0, 0.6, 0.2), {0.01, 5.0, 0.01});
    RotationReference<long double> extended(f.inertia, f.orientation, f.angular_momentum);
    RotationReference<Wide> quadruple(f.inertia, f.orientation, f.angular_momentum);
    extended.advance(4.0);
    quadruple.advance(4.0);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT(std::fabs(double(extended.orientation()[i] - quadruple.orientation()[i])), 2e-16);
}

// Bounds are a few times the measured errors.
TEST(FreeRotation, OrientationAfterTenSeconds) {
    const auto error = [](const Vec3& inertia, const Vec3& omega) {
        return Flight::spinning(inertia, omega).error(10.0);
    };
    const Vec3 box = box_inertia(1.0, 0.6, 0.2);
    EXPECT_LT(error(box, {0.01, 5.0, 0.01}), 4e-14);
    EXPECT_LT(error({1.0, 2.0, 3.0}, {1.0, 1.0, 1.0}), 5e-15);
    EXPECT_LT(error({1.0, 2.0, 3.0}, {0.01, 5.0, 0.0}), 2e-14);
    EXPECT_LT(error({2.0, 2.0, 3.0}, {0.3, -1.0, 2.0}), 1e-14);
    EXPECT_LT(error({2.0, 2.0, 1.2}, {0.3, -1.0, 2.0}), 1e-14);
    EXPECT_LT(error({2.0, 2.0 * (1.0 + 1e-12), 1.2}, {0.3, -1.0, 2.0}), 1e-14);
    EXPECT_LT(error({2.0, 2.0, 2.0}, {0.3, -1.0, 2.0}), 1e-14);
    EXPECT_LT(error({2.0, 2.0 * (1.0 + 1e-15), 2.0 * (1.0 - 1e-15)}, {0.3, -1.0, 2.0}), 1e-14);
    EXPECT_LT(error({0.5, 0.5 + 1e-6, 1.0}, {0.5, 1.0, 3.0}), 2e-14);  // plate
    EXPECT_LT(error({0.3, 0.7, 1.0}, {0.5, 1.0, 3.0}), 2e-14);
    EXPECT_LT(error({1.0, 1.0, 1e-6}, {1e-9, -2e-9, 3e-9}), 1e-15);  // hardly rotating
    EXPECT_LT(error({1.0, 2.0, 3.0}, {1e-9, 2e-9, -1e-9}), 1e-15);
}

// A small momentum spins a needle about its own axis: the reference needs all its digits.
TEST(FreeRotation, Needles) {
    const auto error = [](const Vec3& inertia, const Vec3& omega) {
        return Flight::spinning(inertia, omega).error<Wide>(0.1);
    };
    EXPECT_LT(error({1e-6, 1.0, 1.0}, {0.5, 1.0, 0.3}), 2e-15);
    EXPECT_LT(error({1e-6, 1.0, 1.0 + 1e-6}, {0.5, 0.1, 0.3}), 2e-15);
    EXPECT_LT(error({1.0, 1e-6, 1.0 + 0.5e-6}, {0.01, 100.0, 1.0}), 1e-14);
    EXPECT_LT(error({1.0 + 1e-6, 1.0, 1e-6}, {1.0, 0.5, 0.0}), 2e-15);
}

TEST(FreeRotation, FastSpins) {
    const Flight f = Flight::spinning(box_inertia(1.0, 0.6, 0.2), 1e4 * Vec3(0.3, 0.7, 0.2));
    EXPECT_LT(f.error(0.05), 1e-12);  // a phase of 500 rad
}

TEST(FreeRotation, ExactSeparatrix) {
    // m0^2 (I1 - I0)/I0 = m2^2 (I2 - I1)/I2 with I = (2, 3, 6): both are m^2/2.
    for (const Vec3& m : {Vec3(1, 2, 1), Vec3(-1, 2, 1), Vec3(1, -2, 1), Vec3(1, 2, -1), Vec3(-1, -3, -1),
                          Vec3(1, 0, 1), Vec3(1e-3, 5, 1e-3), Vec3(-1e-6, -5, 1e-6)}) {
        for (const double t : {0.1, 1.0, 10.0, -10.0}) {
            const Flight f{Vec3(2.0, 3.0, 6.0), Quat::Identity(), m};
            EXPECT_LT(f.error(t), 2e-13) << m.transpose() << ", " << t;
        }
    }
    // It approaches the middle axis and stays there.
    const Flight f{Vec3(2.0, 3.0, 6.0), Quat::Identity(), Vec3(1, 2, 1)};
    const Vec3 omega = f.body_omega(f.closed().at(1e4));
    EXPECT_NEAR(std::fabs(omega.y()), std::sqrt(6.0) / 3.0, 1e-12);
    EXPECT_LT(std::fabs(omega.x()) + std::fabs(omega.z()), 1e-12);
}

// Near-spheres, symmetric and nearly so, near the separatrix, near and on axes: every error below 1e-12 (1 + omega t).
TEST(FreeRotation, RandomFlights) {
    Random random(31);
    for (int i = 0; i < trials(2000); ++i) {
        const Flight f = random_flight(random, i);
        const double t = random(-6.0, 6.0);
        EXPECT_LT(f.error(t), 1e-13 * (1.0 + std::fabs(t)))
            << i << ": " << f.inertia.transpose() << "; m " << f.body_momentum(f.orientation).transpose();
    }
}

TEST(FreeRotation, PrincipalAxesRotatedInTheBody) {
    Random random(32);
    for (int i = 0; i < trials(300); ++i) {
        const Flight f = random_flight(random, i);
        const Quat axes = random.turn();
        const FreeRotation turned(f.inertia, axes, f.orientation * axes.conjugate(), f.angular_momentum);
        const double t = random(-3.0, 3.0);
        EXPECT_LT(angle(turned.at(t) * axes, f.closed().at(t)), 1e-13) << i;
    }
}

// at(s), restarted there, at(t) is at(s + t); and back again.
TEST(FreeRotation, IsAGroup) {
    Random random(33);
    for (int i = 0; i < trials(3000); ++i) {
        Flight f = random_flight(random, i);
        const double s = random(-5.0, 5.0), t = random(-5.0, 5.0);
        const Quat whole = f.closed().at(s + t), start = f.orientation;
        f.orientation = f.closed().at(s);
        EXPECT_LT(angle(f.closed().at(t), whole), 1e-12) << i;
        EXPECT_LT(angle(f.closed().at(-s), start), 1e-12) << i;
    }
}

// With L reversed, the body retraces its motion.
TEST(FreeRotation, ReversesInTime) {
    Random random(34);
    for (int i = 0; i < trials(3000); ++i) {
        Flight f = random_flight(random, i);
        const double t = random(0.0, 5.0);
        const Quat back = f.closed().at(-t);
        f.angular_momentum = -f.angular_momentum;
        EXPECT_LT(angle(f.closed().at(t), back), 1e-13) << i;
    }
}

TEST(FreeRotation, KeepsEnergyAndLengthForHours) {
    Random random(35);
    for (int i = 0; i < trials(1000); ++i) {
        const Flight f = random_flight(random, i);
        const FreeRotation closed = f.closed();
        const long double before = twice_energy(f, f.orientation);
        for (const double t : {1e-3, 1.0, 60.0, 3600.0, 1e5}) {
            const Quat q = closed.at(t);
            EXPECT_LT(std::fabs(double(twice_energy(f, q) / before - 1)), 1e-13) << i << ", " << t;
            EXPECT_NEAR(q.norm(), 1.0, 4e-16);
        }
    }
}

// omega in body axes has the period 4 K / lambda; the orientation also rotates about L meanwhile.
TEST(FreeRotation, ReturnsAfterItsPeriod) {
    const struct {
        Vec3 omega, half_way;
        double period;
    } cases[] = {{{0.01, 5.0, 0.0}, {0.01, -5.0, 0.0}, 10.5321102482},
                 {{1.0, 1.0, 1.0}, {-1.0, -1.0, 1.0}, 6.4227030842}};
    for (const auto& c : cases) {
        const Flight f = Flight::spinning({1.0, 2.0, 3.0}, c.omega);
        const FreeRotation closed = f.closed();
        for (int n = 1; n <= 3; ++n) {
            const Vec3 omega = f.body_omega(closed.at(n * c.period));
            EXPECT_LT(std::asin(omega.cross(c.omega).norm() / omega.norm() / c.omega.norm()), 1e-9);
            EXPECT_GT(omega.dot(c.omega), 0.0);
        }
        // After half a period it has flipped: only the axis that omega circles keeps its sign.
        EXPECT_LT((f.body_omega(closed.at(0.5 * c.period)) - c.half_way).norm(), 1e-8);
    }
}

// The box of the comparison with other programs: spinning about its middle axis, frame by frame.
TEST(FreeRotation, MiddleAxisBoxAtEveryFrame) {
    const Flight f = Flight::spinning(box_inertia(1.0, 0.6, 0.2), {0.01, 5.0, 0.01});
    const FreeRotation closed = f.closed();
    RotationReference<Wide> reference(f.inertia, f.orientation, f.angular_momentum);
    const long double before = twice_energy(f, f.orientation);
    double most = 0.0;
    for (int frame = 1; frame <= 600; ++frame) {
        reference.advance(frame / 60.0 - (frame - 1) / 60.0);
        const Quat q = closed.at(frame / 60.0);
        most = std::max(most, reference.angle_to(q));
        EXPECT_LT(std::fabs(double(twice_energy(f, q) / before - 1)), 1e-14);
    }
    EXPECT_LT(most, 1e-13);
}

TEST(FreeRotation, SteadySpins) {
    Random random(36);
    for (int i = 0; i < trials(300); ++i) {
        Flight f;
        f.inertia = random_inertia(random, i / 3);
        // Rotated by zero or half a turn: about the middle axis, rounding would grow.
        f.orientation = i % 2 ? Quat::Identity() : Quat(0.0, 0.0, 1.0, 0.0);
        const Vec3 axis = f.orientation * Vec3::Unit(i % 3);
        const double rate = std::ldexp(random(-1.0, 1.0), random.below(50) - 36), t = random(-100.0, 100.0);
        f.angular_momentum = rate * f.inertia[i % 3] * axis;
        const SinCos half = sincos(0.5 * rate * t);
        const Quat expected =
            Quat(half.cos, half.sin * axis.x(), half.sin * axis.y(), half.sin * axis.z()) * f.orientation;
        EXPECT_LT(angle(f.closed().at(t), expected), 1e-15 * (1.0 + std::fabs(rate * t))) << i;
    }
    // Fast, for an hour: 3.6e7 rad, correct to the rounding of that phase.
    const Flight fast = Flight::spinning({1.0, 2.0, 3.0}, {0.0, 1e4, 0.0});
    EXPECT_LT(angle(fast.closed().at(3600.0), Quat(std::cos(1.8e7), 0.0, std::sin(1.8e7), 0.0)), 1e-8);
}

TEST(FreeRotation, AtRestNothingChanges) {
    const Quat q = Quat(0.1, 0.2, 0.3, 0.4).normalized();
    EXPECT_EQ(FreeRotation(Vec3(1, 2, 3), Quat::Identity(), q, Vec3::Zero()).at(1e9).coeffs(), q.coeffs());
    EXPECT_EQ(FreeRotation().at(5.0).coeffs(), Quat::Identity().coeffs());
}

// No division by an underflowed number.
TEST(FreeRotation, TinyAndHugeNumbers) {
    Random random(37);
    const double scales[] = {1e-300, 1e-160, 1e-30, 1.0, 1e30, 1e150};
    for (int i = 0; i < trials(3000); ++i) {
        Flight f = random_flight(random, i);
        const double scale = scales[i % 6];
        const Quat plain = f.closed().at(1.5);
        f.inertia *= scale;
        f.angular_momentum *= scale;
        EXPECT_LT(angle(f.closed().at(1.5), plain), 1e-13) << i;
        // One component negligible.
        Vec3 m = random.vector(1.0);
        m[i % 3] = std::ldexp(1.0, -random.below(1074));
        m[(i + 1) % 3] *= i % 2 ? 1.0 : std::ldexp(1.0, -random.below(1074));
        f = random_flight(random, i);
        f.angular_momentum = f.orientation * m;
        if (i % 4 == 0) f.orientation = Quat::Identity(), f.angular_momentum = m;
        for (const double t : {-1.0, 0.0, 1e3}) {
            const Quat q = f.closed().at(t);
            EXPECT_NEAR(q.norm(), 1.0, 1e-15) << i;
            EXPECT_LT(std::fabs(double(twice_energy(f, q) / twice_energy(f, f.orientation) - 1)), 1e-12) << i;
        }
    }
}

// The same rotation has a continuous quaternion, without a change of sign: interpolation between frames does not jump.
TEST(FreeRotation, QuaternionsDoNotJump) {
    Random random(38);
    for (int i = 0; i < trials(300); ++i) {
        const FreeRotation closed = random_flight(random, i).closed();
        Quat last = closed.at(0.0);
        for (int k = 1; k <= 200; ++k) {
            const Quat q = closed.at(0.1 * k);
            EXPECT_GT(q.dot(last), 0.9) << i;
            last = q;
        }
    }
}

}  // namespace tumble::free_rotation_test
