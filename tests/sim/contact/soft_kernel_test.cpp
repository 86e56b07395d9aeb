// The soft solver's inner loops: the same bits at any width, and one contact against closed forms.
#include "sim/contact/soft/soft_kernel.h"
#include "sim/contact/model/settings.h"
#include "sim/contact/soft/settings.h"
#include "sim/random_shapes.h"
#include "sim/soft_kernels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::soft_kernel_test {
using namespace tumble::soft;
using tumble::testing::kernels;
using tumble::testing::Random;
using tumble::testing::trials;

namespace {

using Rows = ManifoldRows<float>;
using Point = PointRows<float>;

Vec3 to_double(const Vector3<float>& v) { return {v.x, v.y, v.z}; }

/// Memory aligned to 64 bytes.
struct alignas(64) Line {
    float f[16] = {};
};

struct LanePoint {
    Vec3 arm = Vec3::Zero();  // from A's center
    double separation = 0.0, impulse = 0.0;
    double share = 1.0;
};
struct Lane {
    std::uint32_t a = 0, b = 0;  // slots; 0 stands still
    bool moves_a = true, moves_b = true;
    Vec3 normal = Vec3::UnitY(), tangent = Vec3::UnitX();
    Vec3 between = Vec3::Zero();  // from B's center to A's
    double friction = 0.0, size = 1.0, spread = 1.0;
    Vec3 start_friction = Vec3::Zero();
    std::vector<LanePoint> points;
};

/// Bodies and one color of manifolds: no two share a moving body.
class OneColor {
public:
    OneColor(const Kernel& kernel, std::size_t bodies, const std::vector<Lane>& lanes)
        : kernel_(kernel),
          lanes_(std::size_t(kernel.lanes)),
          groups_((lanes.size() + lanes_ - 1) / lanes_),
          state_(bodies + 1),
          inertia_((bodies + 2) / 2),
          forces_(inertia_.size()),
          start_(inertia_.size()),
          rows_((groups_ * group_rows * lanes_ + 15) / 16),
          bodies_(2 * lanes_ * groups_, 0),
          moved_(2 * groups_, 0),
          points_(groups_, 0) {
        for (std::size_t k = 0; k < lanes.size(); ++k) pack(k, lanes[k]);
    }
    float* state(std::size_t slot) { return state_[slot].f; }
    float* inertia(std::size_t slot) { return inertia_[slot / 2].f + 8 * (slot % 2); }
    float* force(std::size_t slot) { return forces_[slot / 2].f + 8 * (slot % 2); }
    ManifoldLane manifold(std::size_t lane) {
        return {reinterpret_cast<float*>(rows_.data()) + (lane / lanes_) * group_rows * lanes_ + lane % lanes_, lanes_};
    }
    float impulse(std::size_t lane, std::size_t point) { return manifold(lane).point(point)[&Point::impulse]; }
    Vec3 friction(std::size_t lane) { return to_double(manifold(lane).vector(&Rows::friction)); }

    void prepare() { kernel_.prepare(groups(), 0, groups_, bodies()); }
    void warm_start() { kernel_.warm_start(groups(), 0, groups_, bodies()); }
    void correct(float rate) { kernel_.correct(groups(), 0, groups_, bodies(), {rate, alike, unlike, fixed}); }
    void accelerate(bool again) { kernel_.accelerate(1, state_.size(), bodies(), again); }
    void move(float substep) { kernel_.move(1, state_.size(), bodies(), substep); }
    void sum() { kernel_.sum(groups(), 0, groups_); }
    void relax(float rate) { kernel_.relax(groups(), 0, groups_, bodies(), {rate, alike, unlike, fixed}); }

    Softness alike{0.0f, 1.0f, 0.0f}, unlike{0.0f, 1.0f, 0.0f}, fixed{0.0f, 1.0f, 0.0f};

private:
    Groups groups() { return {reinterpret_cast<float*>(rows_.data()), bodies_.data(), moved_.data(), points_.data()}; }
    Bodies bodies() {
        return {reinterpret_cast<float*>(state_.data()), reinterpret_cast<float*>(inertia_.data()),
                reinterpret_cast<float*>(forces_.data()), reinterpret_cast<float*>(start_.data())};
    }
    void pack(std::size_t k, const Lane& lane) {
        const std::size_t group = k / lanes_, l = k % lanes_;
        bodies_[2 * lanes_ * group + l] = std::uint32_t(body_floats) * lane.a;
        bodies_[2 * lanes_ * group + lanes_ + l] = std::uint32_t(body_floats) * lane.b;
        moved_[2 * group] |= std::uint16_t((lane.a && lane.moves_a) << l);
        moved_[2 * group + 1] |= std::uint16_t((lane.b && lane.moves_b) << l);
        points_[group] = std::max(points_[group], std::uint8_t(lane.points.size()));
        const ManifoldLane to = manifold(k);
        to.set(&Rows::normal, lane.normal);
        to.set(&Rows::tangent, lane.tangent);
        to[&Rows::friction_coefficient] = float(lane.friction);
        to.set(&Rows::between, lane.between);
        to[&Rows::size] = float(lane.size);
        to[&Rows::spread] = float(lane.spread);
        to.set(&Rows::friction, lane.start_friction);
        for (std::size_t i = 0; i < lane.points.size(); ++i) {
            const LanePoint& p = lane.points[i];
            to.point(i).set(&Point::arm, p.arm);
            to.point(i)[&Point::present] = 1.0f;
            to.point(i)[&Point::load_share] = float(p.share);
            to.point(i)[&Point::separation] = float(p.separation);
            to.point(i)[&Point::impulse] = float(p.impulse);
        }
    }

    const Kernel& kernel_;
    std::size_t lanes_, groups_;
    std::vector<Line> state_, inertia_, forces_, start_, rows_;
    std::vector<std::uint32_t> bodies_;
    std::vector<std::uint16_t> moved_;
    std::vector<std::uint8_t> points_;
};

void random_mass(Random& random, float& inverse, float* inertia) {
    inverse = float(random(0.1, 2.0));
    const Mat3 root = (Mat3() << random(0.5, 2.0), 0, 0, random(-0.5, 0.5), random(0.5, 2.0), 0, random(-0.5, 0.5),
                       random(-0.5, 0.5), random(0.5, 2.0))
                          .finished();
    const Mat3 tensor = root * root.transpose();
    const double entries[] = {tensor(0, 0), tensor(0, 1), tensor(0, 2), tensor(1, 1), tensor(1, 2), tensor(2, 2)};
    for (int i = 0; i < 6; ++i) inertia[i] = float(entries[i]);
}

/// A ball of mass m and radius r on a body that does not move, its center at height r: slot 1.
constexpr double m = 2.0, r = 0.5, moment_of_inertia = 0.4 * m * r * r;
OneColor ball(const Kernel& kernel, Lane lane, const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
    lane.b = 1;
    OneColor color(kernel, 1, {lane});
    for (int i = 0; i < 3; ++i) {
        color.state(1)[i] = float(velocity[i]);
        color.state(1)[3 + i] = float(spin[i]);
    }
    color.state(1)[inverse_mass] = float(1.0 / m);
    for (const int i : {0, 3, 5}) color.inertia(1)[i] = float(1.0 / moment_of_inertia);
    color.prepare();
    return color;
}
Lane ball_lane(double friction, double separation = 0.0) {
    Lane lane;
    lane.friction = friction;
    lane.between = Vec3(0.0, -r, 0.0);
    lane.points = {{Vec3::Zero(), separation, 0.0}};
    return lane;
}

/// Between bodies 1 and 2, which both move, in either order.
Lane lane_of_two(Random& random) {
    Lane lane;
    lane.a = 1;
    lane.b = 2;
    lane.normal = random.direction();
    lane.between = random.vector(1.0);
    return lane;
}

}  // namespace

TEST(SoftKernel, TheSameBitsAtAnyWidth) {
    for (int trial = 0; trial < trials(40); ++trial) {
        std::vector<std::vector<float>> results;
        const auto all = kernels();
        for (const Kernel* kernel : all) {
            Random random{std::uint64_t(trial)};
            const int count = 1 + random.below(60);
            std::vector<Lane> lanes;
            for (int k = 0; k < count; ++k) {
                Lane lane;
                lane.b = std::uint32_t(2 * k + 2);
                lane.moves_b = random.below(8) != 0;
                if (random.below(4) != 0 || !lane.moves_b) lane.a = std::uint32_t(2 * k + 1);
                lane.normal = random.direction();
                lane.tangent = random.below(2) ? Vec3(Vec3::Zero()) : random.direction();
                lane.friction = random(0.0, 1.0);
                lane.between = random.vector(1.0);
                lane.size = random(0.01, 3.0);
                for (int i = 0; i < 3; ++i) lane.start_friction[i] = random(-0.01, 0.01);
                for (int i = 1 + random.below(4); i > 0; --i)
                    lane.points.push_back({random.vector(1.0), random(-0.05, 0.02), random(0.0, 0.1)});
                if (random.below(3) == 0) {  // idle
                    for (LanePoint& p : lane.points) p.impulse = 0.0;
                    lane.start_friction.setZero();
                }
                lanes.push_back(lane);
            }
            OneColor color(*kernel, std::size_t(2 * count), lanes);
            for (std::size_t s = 1; s <= std::size_t(2 * count); ++s) {
                for (int i = 0; i < 6; ++i) {
                    color.state(s)[i] = float(random(-1.0, 1.0));
                    color.force(s)[i] = float(random(-0.02, 0.02));
                }
                random_mass(random, color.state(s)[inverse_mass], color.inertia(s));
            }
            color.alike = {float(random(10.0, 100.0)), 0.7f, 0.3f};
            color.unlike = {float(random(10.0, 100.0)), 0.8f, 0.2f};
            color.fixed = {float(random(10.0, 100.0)), 0.9f, 0.1f};
            color.prepare();
            for (int step = 0; step < 4; ++step) {
                color.accelerate(step > 0);
                if (step == 0) color.warm_start();
                color.correct(480.0f);
                color.move(1.0f / 480.0f);
                color.relax(480.0f);
            }
            color.sum();
            std::vector<float> result;
            for (std::size_t s = 0; s <= std::size_t(2 * count); ++s)
                result.insert(result.end(), color.state(s), color.state(s) + body_floats);
            for (std::size_t k = 0; k < lanes.size(); ++k) {
                const ManifoldLane lane = color.manifold(k);
                const auto total = lane.total_impulse();
                for (const auto& v :
                     {lane.vector(&Rows::friction), lane.vector(&Rows::friction_sum), total.linear, total.angular})
                    result.insert(result.end(), {v.x, v.y, v.z});
                for (std::size_t i = 0; i < lanes[k].points.size(); ++i)
                    result.insert(result.end(), {lane.point(i)[&Point::impulse], lane.point(i)[&Point::impulse_sum]});
            }
            for (const float f : result) ASSERT_TRUE(std::isfinite(f));
            results.push_back(result);
        }
        for (std::size_t k = 1; k < results.size(); ++k) {
            ASSERT_EQ(results[k].size(), results[0].size());
            // Equal except for the sign of a zero: adding a neighbor's unused points turns -0 into +0.
            for (std::size_t i = 0; i < results[0].size(); ++i)
                ASSERT_EQ(results[k][i], results[0][i]) << all[k]->lanes << " lanes, " << i;
        }
    }
}

// A body that does not move is read and never written.
TEST(SoftKernel, FixedBodiesAreNotWritten) {
    for (const Kernel* kernel : kernels()) {
        Lane lane = ball_lane(0.5, -0.01);
        lane.a = 2;
        lane.moves_a = false;
        lane.b = 1;
        lane.points[0].arm = Vec3(0.3, 0.2, 0.1);
        lane.between = Vec3(0.0, -r, 0.0) - lane.points[0].arm;
        OneColor color(*kernel, 2, {lane});
        color.state(1)[1] = -1.0f;
        color.state(2)[0] = 0.25f;  // a belt
        color.state(1)[inverse_mass] = color.inertia(1)[0] = color.inertia(1)[3] = color.inertia(1)[5] = 1.0f;
        color.prepare();
        color.correct(480.0f);
        color.relax(480.0f);
        EXPECT_EQ(color.state(2)[0], 0.25f);
        EXPECT_EQ(color.state(2)[1], 0.0f);
        EXPECT_GT(color.state(1)[0], 0.0f);  // it carries the ball along
        for (int i = 0; i < body_floats; ++i) EXPECT_EQ(color.state(0)[i], 0.0f);
    }
}

// j = m v: a ball's mass at its own center; less through an arm across the normal.
TEST(SoftKernel, AContactStopsAnApproach) {
    for (const Kernel* kernel : kernels()) {
        OneColor central = ball(*kernel, ball_lane(0.0), {0.0, -3.0, 0.0});
        central.relax(480.0f);
        EXPECT_NEAR(central.impulse(0, 0), m * 3.0, 1e-5);
        EXPECT_NEAR(central.state(1)[1], 0.0, 1e-6);
        Lane lane = ball_lane(0.0);
        lane.between = Vec3(0.4, -0.3, 0.0);
        OneColor aside = ball(*kernel, lane, {0.0, -3.0, 0.0});
        aside.relax(480.0f);
        const double j = 3.0 / (1.0 / m + 0.4 * 0.4 / moment_of_inertia);
        EXPECT_NEAR(aside.impulse(0, 0), j, 1e-5);
        EXPECT_NEAR(aside.state(1)[1], -3.0 + j / m, 1e-5);
        EXPECT_NEAR(aside.state(1)[5], 0.4 * j / moment_of_inertia, 1e-4);  // about z: x arm times y impulse
        OneColor leaving = ball(*kernel, ball_lane(0.5), {1.0, 0.1, 0.0});
        leaving.correct(480.0f);
        leaving.relax(480.0f);
        EXPECT_EQ(leaving.impulse(0, 0), 0.0f);
        EXPECT_EQ(leaving.state(1)[0], 1.0f);
    }
}

// A point with a gap may close it within the substep, and no more.
TEST(SoftKernel, AGapIsClosedAndNotCrossed) {
    for (const Kernel* kernel : kernels()) {
        OneColor color = ball(*kernel, ball_lane(0.0, 0.005), {0.0, -3.0, 0.0});
        color.correct(480.0f);
        EXPECT_NEAR(color.state(1)[1], -0.005 * 480.0, 1e-4);
        OneColor slow = ball(*kernel, ball_lane(0.0, 0.005), {0.0, -1.0, 0.0});
        slow.correct(480.0f);
        EXPECT_EQ(slow.state(1)[1], -1.0f);
    }
}

// Soft constraint: j' = j - M c (v + b) - k j with b = rate o (1 + o / o2), o = s + slop, at most the push limit.
TEST(SoftKernel, AnOverlapIsPushedOutSoftlyAndTheSpeedRemoved) {
    for (const Kernel* kernel : kernels()) {
        Lane lane = ball_lane(0.0, -0.01);
        lane.size = 0.001 / tuning::soft_slop;
        OneColor color = ball(*kernel, lane, Vec3::Zero());
        color.fixed = {50.0f, 0.8f, 0.2f};
        color.correct(480.0f);
        const double bias = 50.0 * 0.009 * (1.0 + 0.009 / (tuning::soft_twice_as_stiff * lane.size));
        EXPECT_NEAR(color.impulse(0, 0), m * 0.8 * bias, 1e-5);
        color.correct(480.0f);
        const double first = m * 0.8 * bias, v = first / m;
        EXPECT_NEAR(color.impulse(0, 0), first - m * 0.8 * (v - bias) - 0.2 * first, 1e-5);
        color.relax(480.0f);
        EXPECT_NEAR(color.state(1)[1], 0.0, 1e-6);
        lane.size = 0.1 / tuning::correction_limit;
        OneColor limited = ball(*kernel, lane, Vec3::Zero());
        limited.fixed = color.fixed;
        limited.correct(480.0f);
        EXPECT_NEAR(limited.state(1)[1], 0.8 * 0.1, 1e-6);
    }
}

// Each kind of pair has its softness; between unlike masses, both moving, no overlap is pushed out twice as fast.
TEST(SoftKernel, UnlikeMassesHaveSofterContacts) {
    for (const Kernel* kernel : kernels())
        for (const double other : {0.0, 1.0, 0.6, 0.4, 1.6, 2.4}) {  // inverse mass, 1/kg, beside that of 1 kg
            Lane lane = ball_lane(0.0, -0.01);
            lane.size = 0.1;  // the overlap is a tenth of it
            lane.between = Vec3::Zero();
            lane.a = 1;
            lane.b = 2;
            OneColor color(*kernel, 2, {lane});
            color.state(1)[inverse_mass] = 1.0f;
            color.state(2)[inverse_mass] = float(other);
            for (const std::size_t slot : {1, 2})
                color.inertia(slot)[0] = color.inertia(slot)[3] = color.inertia(slot)[5] = 1.0f;
            color.alike = {10.0f, 0.8f, 0.2f};
            color.unlike = {8.0f, 0.6f, 0.4f};
            color.fixed = {12.0f, 0.9f, 0.1f};
            color.prepare();
            color.correct(480.0f);
            const bool unlike = other == 0.4 || other == 2.4;
            const double overlap = 0.01 - tuning::soft_slop * lane.size;
            const double expected =
                (unlike ? 0.6 * 8.0 : 2.0 * (other == 0.0 ? 0.9 * 12.0 : 0.8 * 10.0)) * overlap / (1.0 + other);
            EXPECT_NEAR(color.impulse(0, 0), expected, 1e-5) << other;
        }
}

// Sliding: mu j against the slip, in any direction; the ball is spun up by it. Sticking: the slip ends. With arm r
// down, an impulse f changes the slip by f (1/m + r^2 / I) = 3.5 f / m.
TEST(SoftKernel, FrictionIsADisc) {
    for (const Kernel* kernel : kernels())
        for (const double angle : {0.0, 0.7, 2.0, -1.1}) {
            const Vec3 direction(std::cos(angle), 0.0, std::sin(angle));
            OneColor slides = ball(*kernel, ball_lane(0.3), 5.0 * direction + Vec3(0.0, -2.0, 0.0));
            slides.relax(480.0f);
            const double j = m * 2.0;
            EXPECT_NEAR(slides.friction(0).head<2>().norm(), 0.3 * j, 1e-5);
            EXPECT_NEAR(slides.state(1)[0], (5.0 - 0.3 * 2.0) * direction.x(), 1e-5);
            EXPECT_NEAR(slides.state(1)[2], (5.0 - 0.3 * 2.0) * direction.z(), 1e-5);
            // The spin of the impulse -0.3 j direction at (0, -r, 0).
            const Vec3 spin = Vec3(0.0, -r, 0.0).cross(Vec3(-0.3 * j * direction)) / moment_of_inertia;
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(slides.state(1)[3 + i], spin[i], 1e-4);
            OneColor sticks = ball(*kernel, ball_lane(0.3), 0.5 * direction + Vec3(0.0, -2.0, 0.0));
            sticks.relax(480.0f);
            EXPECT_NEAR(sticks.friction(0).head<2>().norm(), m * 0.5 / 3.5, 1e-5);
            EXPECT_NEAR(sticks.state(1)[0], (0.5 - 0.5 / 3.5) * direction.x(), 1e-5);
        }
}

// Several points resist a spin by mu times their loads' levers.
TEST(SoftKernel, TorsionalFrictionIsMuTimesTheLevers) {
    for (const Kernel* kernel : kernels()) {
        Lane lane = ball_lane(0.5);
        lane.points.clear();
        for (const double side : {-1.0, 1.0}) lane.points.push_back({Vec3(0.2 * side, 0.0, 0.0), 0.0, 0.4});
        OneColor fast = ball(*kernel, lane, Vec3::Zero(), {0.0, 10.0, 0.0});
        fast.correct(480.0f);
        EXPECT_NEAR(fast.friction(0).z(), -0.5 * 0.2 * 0.8, 1e-6);
        EXPECT_NEAR(fast.state(1)[4], 10.0 - 0.5 * 0.2 * 0.8 / moment_of_inertia, 1e-4);
        OneColor slow = ball(*kernel, lane, Vec3::Zero(), {0.0, 0.1, 0.0});
        slow.correct(480.0f);
        EXPECT_NEAR(slow.state(1)[4], 0.0, 1e-6);
        // Friction of an area: half as much where the load is uniform, and all of it where one point has the load.
        lane.spread = 0.5;
        OneColor even = ball(*kernel, lane, Vec3::Zero(), {0.0, 10.0, 0.0});
        even.correct(480.0f);
        EXPECT_NEAR(even.friction(0).z(), -0.5 * 0.5 * 0.2 * 0.8, 1e-6);
        lane.points[0].impulse = 0.8;
        lane.points[1].impulse = 0.0;
        OneColor aside = ball(*kernel, lane, Vec3::Zero(), {0.0, 10.0, 0.0});
        aside.correct(480.0f);
        EXPECT_NEAR(aside.friction(0).z(), -0.5 * 0.2 * 0.8, 1e-6);
    }
}

// Friction acts at the point given by the shares, if all points touch; otherwise in the middle of those that do.
TEST(SoftKernel, FrictionActsAtTheCentroidOfTheArea) {
    for (const Kernel* kernel : kernels())
        for (const double gap : {0.0, 0.1}) {
            Lane lane = ball_lane(0.5);
            lane.points.clear();
            for (const double side : {-1.0, 1.0})
                lane.points.push_back({Vec3(0.2 * side, 0.0, 0.0), 0.0, 0.4, 1.0 + 0.25 * side});
            lane.points.push_back({Vec3(0.0, 0.0, 0.3), gap, 0.0, 1.0});
            OneColor color = ball(*kernel, lane, Vec3::Zero());
            const auto arm = color.manifold(0).vector(&Rows::friction_arm);
            EXPECT_NEAR(arm.x, gap > 0.0 ? 0.0 : 0.2 * 0.5 / 3.0, 1e-6);
            EXPECT_NEAR(arm.z, gap > 0.0 ? 0.3 * 0.01 / 2.01 : 0.1, 1e-6);
        }
}

// A sweep over four points at once, from couplings, against the same one by one in double precision: j = (v - r) / K
// for each point in sequence, K = 1/m + (r x n) I^-1 (r x n) over both bodies.
TEST(SoftKernel, PointsAreCoupled) {
    for (const Kernel* kernel : kernels())
        for (int trial = 0; trial < trials(50); ++trial) {
            Random random{std::uint64_t(1000 + trial)};
            Lane lane = lane_of_two(random);
            for (int i = 0; i < 4; ++i) lane.points.push_back({random.vector(0.7), 0.0, 0.0});
            OneColor color(*kernel, 2, {lane});
            Vec3 velocity[2], spin[2];
            Mat3 inverse_inertia[2];
            double inverse[2];
            for (std::size_t k = 0; k < 2; ++k) {
                float* state = color.state(k + 1);
                random_mass(random, state[inverse_mass], color.inertia(k + 1));
                inverse[k] = state[inverse_mass];
                const float* f = color.inertia(k + 1);
                inverse_inertia[k] << f[0], f[1], f[2], f[1], f[3], f[4], f[2], f[4], f[5];
                velocity[k] = random.vector(1.0) + (k ? -2.0 : 2.0) * lane.normal;
                spin[k] = random.vector(1.0);
                for (int i = 0; i < 3; ++i) {
                    state[i] = float(velocity[k][i]);
                    state[3 + i] = float(spin[k][i]);
                }
            }
            color.prepare();
            color.relax(480.0f);
            for (int i = 0; i < 4; ++i) {
                const Vec3 arm[2] = {lane.points[std::size_t(i)].arm, lane.points[std::size_t(i)].arm + lane.between};
                double compliance = inverse[0] + inverse[1];
                for (int k = 0; k < 2; ++k)
                    compliance += arm[k].cross(lane.normal).dot(inverse_inertia[k] * arm[k].cross(lane.normal));
                const double v =
                    lane.normal.dot(velocity[1] + spin[1].cross(arm[1]) - velocity[0] - spin[0].cross(arm[0]));
                const double j = std::max(0.0, -v / compliance);
                for (int k = 0; k < 2; ++k) {
                    const Vec3 impulse = (k ? j : -j) * lane.normal;
                    velocity[k] += inverse[k] * impulse;
                    spin[k] += inverse_inertia[k] * arm[k].cross(impulse);
                }
                EXPECT_NEAR(color.impulse(0, std::size_t(i)), j, 2e-5);
            }
            for (std::size_t k = 0; k < 2; ++k)
                for (int i = 0; i < 3; ++i) {
                    EXPECT_NEAR(color.state(k + 1)[i], velocity[k][i], 5e-5);
                    EXPECT_NEAR(color.state(k + 1)[3 + i], spin[k][i], 2e-4);
                }
        }
}

// Friction, solved last, ends the slip that remains after the normal impulse; solved first, it leaves the normal
// impulse to stop the motion that it has caused. One point, well held, anywhere on two bodies.
TEST(SoftKernel, FrictionAndNormalImpulsesAreCoupled) {
    for (const Kernel* kernel : kernels())
        for (int trial = 0; trial < trials(50); ++trial) {
            Random random{std::uint64_t(2000 + trial)};
            Lane lane = lane_of_two(random);
            lane.friction = 100.0;
            lane.points = {{random.vector(0.7), 0.0, 0.5}};
            for (const bool correcting : {false, true}) {
                OneColor color(*kernel, 2, {lane});
                for (std::size_t k = 1; k <= 2; ++k) {
                    random_mass(random, color.state(k)[inverse_mass], color.inertia(k));
                    for (int i = 0; i < 6; ++i)
                        color.state(k)[i] = float(random(-0.3, 0.3) + (k == 1 && i < 3 ? 2.0 * lane.normal[i] : 0.0));
                }
                color.prepare();
                if (correcting)
                    color.correct(480.0f);
                else
                    color.relax(480.0f);
                const auto velocity = [&](std::size_t k, const Vec3& arm) {
                    const float* f = color.state(k);
                    return Vec3(Vec3(f[0], f[1], f[2]) + Vec3(f[3], f[4], f[5]).cross(arm));
                };
                const Vec3& arm = lane.points[0].arm;
                const Vec3 relative = velocity(2, arm + lane.between) - velocity(1, arm);
                if (correcting)
                    EXPECT_NEAR(relative.dot(lane.normal), 0.0, 1e-4);
                else
                    EXPECT_LT(relative.cross(lane.normal).norm(), 1e-4);
                EXPECT_GT(color.impulse(0, 0), 0.0f);
            }
        }
}

}  // namespace tumble::soft_kernel_test
