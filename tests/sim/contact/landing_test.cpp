// End of bouncing: the acceleration at contacts and the bodies that they hold, independent of the order of bodies and
// contacts.
#include "sim/ccd/trajectory.h"
#include "sim/contact/direct/settings.h"
#include "sim/event_driven/contact_transition.h"
#include "sim/geometry/settings.h"
#include "sim/random_shapes.h"
#include "support/bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble::landing_test {
using namespace tumble::testing;

namespace {

const Vec3 gravity(0.0, -9.81, 0.0);
constexpr double h = 1.0 / 960.0;                        // s
const auto always = [](std::uint32_t) { return true; };  // all loads are known

// Gravity alone, on some bodies.
const ForceField& field() {
    static const ForceField falling = [] {
        SceneDescription scene;
        scene.simulation.gravity = gravity;
        scene.bodies.resize(8);
        return ForceField(scene);
    }();
    return falling;
}

FreeMotion falling() { return {field(), {}, 0.0, h, h}; }

Body at_time(const Body& body, double t) {
    Body there = body;
    if (!body.dynamic()) return there;
    const Motion motion = Trajectory::flight(body, gravity).at(t);
    there.position = motion.position;
    there.orientation = motion.orientation;
    there.rotation = motion.rotation;
    return there;
}

std::vector<Manifold> manifolds(const Body& a, const Body& b, double margin) {
    CollisionScratch scratch;
    scratch.choice = AxisChoice::nearest;
    std::vector<Manifold> found;
    collide(a.collider, b.collider, {a.pose(), b.pose(), margin, scratch, found});
    return found;
}

// The pair's manifold if it has exactly one point.
std::optional<Manifold> one_point(const Body& a, const Body& b, double margin) {
    const auto found = manifolds(a, b, margin);
    if (found.size() != 1 || found[0].count != 1) return std::nullopt;
    return found[0];
}

// The gap's second derivative (m/s^2), by differences; none where the nearest features change.
std::optional<double> gap_acceleration(const Body& a, const Body& b) {
    const double d = 1e-4;
    double gap[3];
    std::uint64_t feature[3];
    for (int k = 0; k < 3; ++k) {
        const auto m = one_point(at_time(a, (k - 1) * d), at_time(b, (k - 1) * d), 1e-3);
        if (!m) return std::nullopt;
        gap[k] = m->points[0].separation;
        feature[k] = m->points[0].feature;
    }
    if (feature[0] != feature[1] || feature[2] != feature[1]) return std::nullopt;
    return (gap[0] - 2.0 * gap[1] + gap[2]) / (d * d);
}

// Gaps between the contacts' own points.
std::vector<Gap> flat_gaps(const std::vector<Contact>& contacts) {
    std::vector<Gap> gaps;
    for (const Contact& c : contacts) gaps.push_back({c.normal, c.corners, {}, c.arm_a, c.arm_b});
    return gaps;
}

double pressing(const Body& a, const Body& b) {
    auto m = *one_point(a, b, 1e-6);
    m.a = 0;
    m.b = 1;
    const std::vector<Body> bodies{a, b};
    std::vector<Contact> contacts;
    add_contacts(m, bodies, contacts);
    std::vector<Gap> gaps;
    make_gaps({m}, bodies, gaps);
    return pressing_acceleration(contacts[0], gaps[0], bodies, falling(), Supports(2));
}

Body ground() {
    BodyDescription d;
    d.type = BodyType::fixed;
    d.shape = PlaneShape{};
    return BodyBuilder().build(d, IntegratorKind::exact);
}

Body random_box(Random& random) {
    return free_box({random(0.3, 1.0), random(0.3, 1.0), random(0.3, 1.0)}, random(0.5, 3.0), Vec3::Zero(),
                    random.vector(2.0), random.turn(), random.vector(4.0));
}

// Moves the body along the manifold's normal until the two just touch, in one point.
bool bring_to_touch(const Body& a, Body& b) {
    for (int round = 0; round < 20; ++round) {
        const auto found = manifolds(a, b, 2.0);
        if (found.empty()) return false;
        double least = 1.0;
        for (int i = 0; i < found[0].count; ++i) least = std::min(least, found[0].points[std::size_t(i)].separation);
        b.position -= least * found[0].normal;
    }
    const auto m = one_point(a, b, 1e-3);
    return m && std::abs(m->points[0].separation) < 1e-12;
}

}  // namespace

TEST(PressingAcceleration, IsTheGapsSecondDerivativeInEitherOrder) {
    Random random(11);
    int corners[3] = {}, all = 0;
    for (int trial = 0; trial < trials(400); ++trial) {
        const Body a = trial % 4 == 0 ? ground() : random_box(random);
        Body b = random_box(random);
        b.position = trial % 4 == 0 ? Vec3(0.0, 1.0, 0.0) : Vec3(1.1 * random.direction());
        if (!bring_to_touch(a, b)) continue;
        const auto measured = gap_acceleration(a, b);
        if (!measured) continue;
        ++all;
        ++corners[int(one_point(a, b, 1e-6)->corners)];
        EXPECT_NEAR(pressing(a, b), *measured, 1e-4 * (10.0 + std::abs(*measured))) << trial;
        EXPECT_NEAR(pressing(b, a), *measured, 1e-4 * (10.0 + std::abs(*measured))) << trial << ", reversed";
    }
    for (const int kind : corners) EXPECT_GE(kind, trials(20));  // crossing edges, and corners of either body
    EXPECT_GE(all, trials(150));
}

// A ball over a face, past an edge, past a corner, and past another ball.
TEST(PressingAcceleration, OnABallIsTheGapsSecondDerivativeToo) {
    Random random(12);
    int all = 0;
    for (int trial = 0; trial < trials(400); ++trial) {
        Body a =
            trial % 4 == 0 ? free_ball(random(0.1, 0.4), 1.0, Vec3::Zero(), random.vector(2.0)) : random_box(random);
        a.angular_momentum = a.inertia_body * random.vector(trial % 4 == 0 ? 4.0 : 1.0);
        a.derive();
        Body b = free_ball(random(0.1, 0.4), 1.0, 1.5 * random.direction(), random.vector(2.0));
        if (!bring_to_touch(a, b)) continue;
        const auto measured = gap_acceleration(a, b);
        if (!measured) continue;
        const auto on = [&](double t) { return one_point(at_time(a, t), at_time(b, t), 1e-3); };
        // Two flags: the ball is over a face, and the gap ends on a line.
        const auto feature = [&](double t) {
            const auto m = on(t);
            const PointGeometry geometry = m->geometry();
            const auto* gap = std::get_if<CurvedGap>(&geometry);
            return std::pair(gap == nullptr, gap && !gap->line.isZero(0.0));
        };
        if (feature(-1e-4) != feature(1e-4)) continue;
        ++all;
        EXPECT_NEAR(pressing(a, b), *measured, 1e-3 * (10.0 + std::abs(*measured))) << trial;
        EXPECT_NEAR(pressing(b, a), *measured, 1e-3 * (10.0 + std::abs(*measured))) << trial << ", reversed";
    }
    EXPECT_GE(all, trials(200));
}

// Chains of contacts through bodies that hold one another: the held bodies do not depend on the order of contacts.
TEST(MarkHeld, DoesNotDependOnTheOrderOfContacts) {
    Random random(5);
    for (int trial = 0; trial < trials(400); ++trial) {
        std::vector<Body> bodies{ground()};
        for (int i = 0; i < 6; ++i)
            bodies.push_back(free_box({0.5, 0.4, 0.3}, 1.0, random.vector(1.0), random.vector(0.02), random.turn(),
                                      random.vector(2.0)));
        std::vector<Contact> contacts;
        for (int k = 0; k < 9; ++k) {
            Contact c;
            c.a = std::uint32_t(random.below(6));
            c.b = c.a + 1 + std::uint32_t(random.below(int(6 - c.a)));
            c.normal = random.direction();
            c.arm_a = random.vector(0.2);
            c.arm_b = random.vector(0.2);
            c.touch_distance = 1e-7;
            c.corners = Corners::of_b;
            contacts.push_back(c);
        }
        Supports held(bodies.size()), other(bodies.size());
        const HoldLimits limits{9.81, 0.0, 0.02};
        std::vector<Gap> gaps = flat_gaps(contacts);
        mark_held(contacts, gaps, bodies, falling(), limits, always, held);
        std::reverse(contacts.begin(), contacts.end());
        std::reverse(gaps.begin(), gaps.end());
        mark_held(contacts, gaps, bodies, falling(), limits, always, other);
        ASSERT_EQ(held, other) << trial;
    }
}

// Resting contact leaves overlaps below a fraction of the radius: a body that an impact makes part there is free,
// whatever the last digit. Deeper overlaps hold a body, to be pushed out.
TEST(MarkHeld, ReleasesRestingBodiesThatPart) {
    std::vector<Body> bodies{
        ground(), free_box({0.5, 0.4, 0.3}, 1.0, {0.0, 0.2, 0.0}, {0.0, 0.5, 0.0}, Quat::Identity(), Vec3::Zero())};
    Contact c;
    c.a = 0;
    c.b = 1;
    c.normal = Vec3::UnitY();
    c.arm_a = c.arm_b = Vec3::Zero();
    c.touch_distance = tuning::touch * bodies[1].radius;
    const double rest = -tuning::direct_slop * bodies[1].radius;
    const auto held = [&](double separation) {
        c.separation = separation;
        Supports marks(2);
        mark_held({c}, flat_gaps({c}), bodies, falling(), {9.81, 0.0, 0.001}, always, marks);
        return !marks[1].none();
    };
    EXPECT_FALSE(held(0.0));
    EXPECT_FALSE(held(rest * (1.0 - 1e-9)));
    EXPECT_FALSE(held(rest * (1.0 + 1e-9)));
    EXPECT_TRUE(held(3.0 * rest));
}

// The end of a hop below the resolution of gaps cannot be found: the hop is over. Higher ones are followed, also where
// the last digits of the positions are coarse.
TEST(ShortHop, IsNoHigherThanTheRoundingOfGaps) {
    const Body floor = ground();
    Body box = free_box({0.5, 0.4, 0.3}, 1.0, {0.0, 0.2, 0.0}, Vec3::Zero(), Quat::Identity(), Vec3::Zero());
    Contact c;
    c.normal = Vec3::UnitY();
    c.arm_a = c.arm_b = Vec3::Zero();
    for (const double far : {0.0, 100.0, 1e4, 1e6}) {
        box.position.x() = far;
        const double gap = gap_rounding(floor, floor.position) + gap_rounding(box, box.position);
        for (const double share : {0.9, 1.1}) {
            box.velocity = Vec3(0.0, std::sqrt(2.0 * 9.81 * share * gap), 0.0);
            EXPECT_EQ(hop_is_shorter(c, floor, box, -9.81, 0.0), share < 1.0) << far;
        }
        EXPECT_TRUE(hop_is_shorter(c, floor, box, -9.81, 1.0));
        EXPECT_FALSE(hop_is_shorter(c, floor, box, 0.0, 1.0));
    }
}

}  // namespace tumble::landing_test
