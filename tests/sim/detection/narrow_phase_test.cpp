// Manifolds from step to step: accumulated impulses stay with the points that still exist.
#include "sim/detection/narrow_phase.h"
#include "sim/detection/settings.h"
#include "sim/dynamics/body_builder.h"
#include "sim/geometry/settings.h"
#include "sim/random_shapes.h"
#include "support/compounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <tuple>

namespace tumble::narrow_phase_test {
using namespace tumble::testing;

namespace {

constexpr double h = 1.0 / 60.0;

Body body_at(const CollisionShape& collider, const Vec3& position, BodyType type = BodyType::dynamic) {
    Body body;
    body.type = type;
    body.collider = collider;
    body.radius = bounding_radius(collider);
    body.position = position;
    return body;
}

void turn(Body& body, const Quat& by) {
    body.orientation = by * body.orientation;
    body.rotation = body.orientation.toRotationMatrix();
}

struct Scene {
    explicit Scene(std::vector<Body> of) : bodies(std::move(of)) {}
    std::vector<Manifold>& find() { return narrow_phase.find(broad_phase.update(bodies, h), bodies, h, pool); }
    std::vector<Body> bodies;
    BroadPhase broad_phase;
    NarrowPhase narrow_phase{1};
    ThreadPool pool{1};
};

Scene box_on_box() {
    return Scene({body_at(box_of({2.0, 1.0, 2.0}), Vec3::Zero(), BodyType::fixed),
                  body_at(box_of({1.0, 1.0, 1.0}), {0.0, 0.999, 0.0})});
}

// Marks every point and the friction with numbers of their own.
void mark(Manifold& m) {
    for (int i = 0; i < m.count; ++i) m.points[std::size_t(i)].impulse = 1.0 + i;
    m.tangent = Vec3::UnitX();
    m.friction[0] = 10.0;
    m.friction[1] = 11.0;
    m.torsion = 12.0;
}

}  // namespace

TEST(NarrowPhaseManifold, KeepsItsImpulses) {
    Scene scene = box_on_box();
    ASSERT_EQ(scene.find().size(), 1u);
    Manifold& first = scene.find()[0];
    ASSERT_EQ(first.count, 4);
    EXPECT_EQ(first.tangent, Vec3::Zero());
    mark(first);
    const Manifold before = first;
    for (int step = 0; step < 20; ++step) {
        if (step > 2) scene.bodies[1].position.x() += 0.004;  // searched again in the same step, then slid along
        const Manifold& m = scene.find()[0];
        ASSERT_EQ(m.count, 4);
        for (int i = 0; i < 4; ++i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            const auto same = std::find_if(before.points.begin(), before.points.end(),
                                           [&](const ContactPoint& q) { return q.feature == p.feature; });
            ASSERT_NE(same, before.points.end());
            EXPECT_EQ(p.impulse, same->impulse);
        }
        EXPECT_EQ(m.tangent, Vec3::UnitX());
        EXPECT_EQ(m.friction[0], 10.0);
        EXPECT_EQ(m.friction[1], 11.0);
        EXPECT_EQ(m.torsion, 12.0);
    }
}

TEST(NarrowPhaseManifold, StartsAnewAfterParting) {
    Scene scene = box_on_box();
    mark(scene.find()[0]);
    scene.bodies[1].position.y() = 2.0;
    EXPECT_TRUE(scene.find().empty());
    scene.bodies[1].position.y() = 0.999;
    const Manifold& m = scene.find()[0];
    EXPECT_EQ(m.tangent, Vec3::Zero());
    EXPECT_EQ(m.friction[0], 0.0);
    EXPECT_EQ(m.torsion, 0.0);
    for (int i = 0; i < m.count; ++i) EXPECT_EQ(m.points[std::size_t(i)].impulse, 0.0);
}

// Other features, the same place: a box turned upside down lies on the same four corners.
TEST(NarrowPhaseManifold, TakesTheNearestPointWhenFeaturesChange) {
    Scene scene = box_on_box();
    mark(scene.find()[0]);
    const Manifold before = scene.find()[0];
    turn(scene.bodies[1], Quat(Eigen::AngleAxisd(EIGEN_PI, Vec3::UnitZ())));
    const Manifold& m = scene.find()[0];
    ASSERT_EQ(m.count, 4);
    bool other = false;
    for (int i = 0; i < 4; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        for (const ContactPoint& q : before.points) other = other || (q.impulse == p.impulse && q.feature != p.feature);
    }
    EXPECT_TRUE(other);
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += m.points[std::size_t(i)].impulse;
    EXPECT_EQ(sum, 10.0) << "each old impulse once";
}

// A crowd in which some bodies hardly move, some slide and some tumble: results from memory against a search every
// time.
TEST(PairMemory, AgreesWithFreshManifolds) {
    Random random(92);
    std::vector<Body> bodies{body_at(box_of({20.0, 1.0, 20.0}), {0.0, -0.5, 0.0}, BodyType::fixed),
                             body_at(surface_of(grid_mesh(8, 10.0, 0.2)), {0.0, -0.2, 0.0}, BodyType::fixed),
                             body_at(HalfSpace{Vec3::UnitY(), 0.0}, Vec3::Zero(), BodyType::fixed)};
    for (int i = 0; i < 60; ++i) {
        const CollisionShape shape = i % 3 == 2 ? CollisionShape(random_hull(random, 12, Vec3::Constant(0.6)))
                                                : CollisionShape(box_of(random.vector(0.3) + Vec3::Constant(0.9)));
        bodies.push_back(body_at(shape, random.vector(1.8) + Vec3(0.0, 1.8, 0.0)));
        if (i % 3 != 1) turn(bodies.back(), random.turn());
    }
    ThreadPool pool(1);
    NarrowPhase with(1), without(1, NarrowPhase::Mode::step, NarrowPhase::Memory::off);
    std::vector<BroadPhase::Pair> pairs;
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        for (std::uint32_t j = std::max(i + 1, 3u); j < bodies.size(); ++j) pairs.push_back({i, j});
    int same = 0, different = 0, missing = 0;
    for (int step = 0; step < trials(60); ++step) {
        for (std::size_t i = 3; i < bodies.size(); ++i) {
            Body& body = bodies[i];
            const double speed = i % 4 == 0 ? 1.0 : 0.01;
            body.velocity = random.vector(speed);
            body.angular_velocity = random.vector(speed);
            body.position += h * body.velocity;
            turn(body, Quat(Eigen::AngleAxisd(h * body.angular_velocity.norm(), body.angular_velocity.normalized())));
        }
        const std::vector<Manifold> found = with.find(pairs, bodies, h, pool),
                                    fresh = without.find(pairs, bodies, h, pool);
        auto m = found.begin();
        for (const Manifold& f : fresh) {
            const auto key = [](const Manifold& of) { return std::tuple(of.a, of.b, of.part); };
            while (m != found.end() && key(*m) < key(f)) ++m;
            double nearest = 1.0;  // of the fresh points, over the smaller radius
            for (int k = 0; k < f.count; ++k) nearest = std::min(nearest, f.points[std::size_t(k)].separation);
            const double size = std::min(bodies[f.a].radius, bodies[f.b].radius);
            if (m == found.end() || key(*m) != key(f)) {
                // Only points that came into reach since the last search may be missing: at that distance they affect
                // no step.
                missing += nearest < 0.02 * size;
                continue;
            }
            if ((m->normal - f.normal).norm() > 0.01) {  // another axis that separates nearly as well
                ++different;
                continue;
            }
            ++same;
            double least = 1.0;
            for (int k = 0; k < m->count; ++k) least = std::min(least, m->points[std::size_t(k)].separation);
            EXPECT_NEAR(least, nearest, tuning::reuse_motion * size) << f.a << " " << f.b << " step " << step;
        }
    }
    EXPECT_EQ(missing, 0);
    EXPECT_GT(same, trials(5000));
    EXPECT_LT(different, same / 50);
}

// Two boxes face to face that shift by less than triggers a search: separations are exact all the same.
TEST(PairMemory, RefreshedSeparationsAreExact) {
    Scene scene = box_on_box();
    scene.find();
    const auto features = [&] { return scene.find()[0].points[0].feature; };
    const std::uint64_t first = features();
    for (const double y : {0.9991, 0.9987, 0.9995}) {
        scene.bodies[1].position = {2e-4, y, -3e-4};
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(scene.find()[0].points[std::size_t(i)].separation, y - 1.0, 1e-15);
        EXPECT_EQ(scene.find()[0].normal, Vec3::UnitY());
        EXPECT_EQ(features(), first);
    }
}

// A box rotated by 45 degrees on another meets it in eight points, of which four are kept. It rocks by less than
// triggers a search: none of the reduced points lies deeper than the deepest kept one by more than the tolerance of
// growth.
TEST(PairMemory, NoReducedPointSinksUndetected) {
    Random random(4);
    Scene scene({body_at(box_of({1.0, 1.0, 1.0}), Vec3::Zero(), BodyType::fixed),
                 body_at(box_of({1.0, 1.0, 1.0}), {0.0, 0.9997, 0.0})});
    const Quat level(Eigen::AngleAxisd(0.25 * EIGEN_PI, Vec3::UnitY()));
    const auto deepest = [](const std::vector<Manifold>& manifolds) {
        double least = 1.0;
        for (const Manifold& m : manifolds)
            for (int i = 0; i < m.count; ++i) least = std::min(least, m.points[std::size_t(i)].separation);
        return least;
    };
    std::size_t most = 0;
    for (int step = 0; step < 200; ++step) {
        scene.bodies[1].orientation = Quat(Eigen::AngleAxisd(8e-4, random.direction())) * level;
        scene.bodies[1].rotation = scene.bodies[1].orientation.toRotationMatrix();
        const double found = deepest(scene.find());
        most = std::max(most, scene.find().size());
        Scene fresh(scene.bodies);
        const double true_deepest = deepest(fresh.find());
        const double radius = scene.bodies[1].radius;
        EXPECT_LE(found,
                  true_deepest + std::max(tuning::sunk_overlap * radius, tuning::sunk_share * std::abs(found)) + 1e-9)
            << step;
    }
    EXPECT_EQ(most, 2u) << "a second manifold was needed";
}

// The upper, wider box tilts: its face separates the two better, and the manifold moves to it. Level again both faces
// separate equally well, and the manifold stays; found anew it would lie on the lower box's face.
TEST(PairMemory, StaysOnItsFace) {
    Scene scene({body_at(box_of({1.0, 1.0, 1.0}), Vec3::Zero(), BodyType::fixed),
                 body_at(box_of({2.0, 1.0, 2.0}), {0.0, 0.9995, 0.0})});
    const auto on_upper = [](Scene& s) { return (s.find()[0].points[0].feature >> 63) != 0; };
    EXPECT_FALSE(on_upper(scene));
    turn(scene.bodies[1], Quat(Eigen::AngleAxisd(0.01, Vec3::UnitZ())));
    EXPECT_TRUE(on_upper(scene));
    turn(scene.bodies[1], Quat(Eigen::AngleAxisd(-0.01, Vec3::UnitZ())));
    EXPECT_TRUE(on_upper(scene));
    Scene fresh(scene.bodies);
    EXPECT_FALSE(on_upper(fresh));
}

// Two boxes cross at their edges and shift a little, until they just touch. The present crossing of the edges is not
// the former one: no gap must be reported where there is none.
TEST(PairMemory, DistinguishesATouchFromAGap) {
    Random random(3);
    for (int trial = 0; trial < trials(300); ++trial) {
        const auto on_edge = [](const Vec3& axis) { return Quat(Eigen::AngleAxisd(0.25 * std::numbers::pi, axis)); };
        Scene scene({body_at(box_of({2.0, 2.0, 2.0}), Vec3::Zero(), BodyType::fixed),
                     body_at(box_of({1.0, 1.0, 1.0}), Vec3::Zero())});
        turn(scene.bodies[0], on_edge(Vec3::UnitZ()));
        turn(scene.bodies[1], Quat(Eigen::AngleAxisd(random(-1.2, 1.2), Vec3::UnitY())) * on_edge(Vec3::UnitX()));
        scene.bodies[1].position = {random(-0.01, 0.01), 1.5 * std::numbers::sqrt2 + 2e-4, random(-0.01, 0.01)};
        ASSERT_EQ(scene.find().size(), 1u);
        turn(scene.bodies[1], Quat(Eigen::AngleAxisd(random(0.0, 1.5e-3), random.direction())));
        NarrowPhase fresh(1, NarrowPhase::Mode::step, NarrowPhase::Memory::off);
        const auto exact = [&] { return fresh.find({{0, 1}}, scene.bodies, h, scene.pool)[0].points[0].separation; };
        for (int i = 0; i < 3; ++i) scene.bodies[1].position.y() -= exact();
        ASSERT_NEAR(exact(), 0.0, 1e-12);
        EXPECT_LT(scene.find()[0].points[0].separation, tuning::touch * scene.bodies[1].radius) << trial;
    }
}

// While both sleep the pair is not in the list; when one wakes, its supporting impulses are restored.
TEST(PairMemory, SurvivesSleep) {
    Scene scene = box_on_box();
    mark(scene.find()[0]);
    scene.bodies[1].asleep = true;
    EXPECT_TRUE(scene.narrow_phase.find({}, scene.bodies, h, scene.pool).empty());
    scene.bodies[1].asleep = false;
    const auto& found = scene.narrow_phase.find({{0, 1}}, scene.bodies, h, scene.pool);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].points[3].impulse, 4.0);
    EXPECT_EQ(found[0].torsion, 12.0);
}

// A pair that was excluded for a while is searched again, though nothing has moved.
TEST(PairMemory, ComesBackAfterAFlight) {
    Scene scene = box_on_box();
    ASSERT_EQ(scene.find().size(), 1u);
    for (bool Body::*out : {&Body::flying, &Body::asleep}) {
        const std::vector<BroadPhase::Pair> pairs{{0, 1}};
        scene.bodies[1].*out = true;
        EXPECT_TRUE(scene.narrow_phase.find(pairs, scene.bodies, h, scene.pool).empty());
        scene.bodies[1].*out = false;
        EXPECT_EQ(scene.narrow_phase.find(pairs, scene.bodies, h, scene.pool).size(), 1u);
    }
}

// A box sinks past a tilted board, far from it though within its bounds, onto the next part of the same body. The gap
// to the board must not be taken for the distance of the body.
TEST(PairMemory, TheGapOfOnePartIsNotThatOfTheCompound) {
    BodyDescription thing;
    thing.shape = compound_of({part(BoxShape{{3.0, 0.05, 0.5}}, Vec3::Zero(),
                                    Quat(Eigen::AngleAxisd(0.25 * std::numbers::pi, Vec3::UnitZ()))),
                               part(BoxShape{{0.3, 0.1, 0.3}}, {0.9, -0.6, 0.0})});
    thing.type = BodyType::fixed;
    Scene scene({BodyBuilder().build(thing, IntegratorKind::symplectic_euler),
                 body_at(box_of({0.2, 0.2, 0.2}), {0.9, -0.35, 0.0})});
    for (double y = -0.35; y > -0.451; y -= 0.005) {  // down to an overlap of 1 mm
        scene.bodies[1].position.y() = y;
        scene.find();
    }
    ASSERT_EQ(scene.find().size(), 1u);
    EXPECT_NEAR(scene.find()[0].points[0].separation, scene.bodies[1].position.y() + 0.45, 1e-12);
}

// A tessellated flat floor is flat, for new and for refreshed manifolds: internal edges cause no bumps.
TEST(PairMemory, InternalEdgesAreFlat) {
    for (const bool sphere : {false, true}) {
        for (const double speed : {0.02, 0.7, 5.0}) {
            const CollisionShape shape = sphere ? CollisionShape(Ball{0.3}) : CollisionShape(box_of({0.6, 0.6, 0.6}));
            Scene scene({body_at(surface_of(grid_mesh(20, 5.0, 0.0)), Vec3::Zero(), BodyType::fixed),
                         body_at(shape, {-1.0, 0.3 - 1e-5, 0.13})});
            Body& body = scene.bodies[1];
            turn(body, Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY())));
            body.velocity = speed * Vec3(1.0, 0.0, 0.3);
            for (int step = 0; step < 30; ++step) {
                body.position += h * body.velocity;
                const auto& found = scene.find();
                ASSERT_FALSE(found.empty());
                EXPECT_NEAR(deepest(found), -1e-5, 1e-14) << step;
                for (const Manifold& m : found) {
                    EXPECT_LT((m.normal - Vec3::UnitY()).norm(), 1e-14) << step;
                    for (int i = 0; i < m.count; ++i) EXPECT_NEAR(m.points[std::size_t(i)].separation, -1e-5, 1e-14);
                }
            }
        }
    }
}

// Sleeping bodies cost nothing: they are in no list, and a ball passes them at the cost of empty space.
TEST(BroadPhase, SleepersAreInNoList) {
    std::vector<Body> bodies;
    for (int i = 0; i < 500; ++i) {
        bodies.push_back(body_at(box_of({1.0, 1.0, 1.0}), {1.01 * (i % 25), 1.01 * (i / 25), 0.0}));
        bodies.back().asleep = true;
    }
    bodies.push_back(body_at(Ball{0.5}, {0.0, 0.0, 20.0}));
    BroadPhase broad_phase;
    EXPECT_TRUE(broad_phase.update(bodies, h).empty());
    EXPECT_EQ(broad_phase.awake(), std::vector<std::uint32_t>{500});
    bodies[7].asleep = false;
    broad_phase.bodies_woke();
    const auto pairs = broad_phase.update(bodies, h);
    EXPECT_EQ(broad_phase.awake(), (std::vector<std::uint32_t>{7, 500}));
    EXPECT_EQ(pairs.size(), 5u);  // the neighbors beside, above and across
    for (const BroadPhase::Pair& pair : pairs) EXPECT_TRUE(pair.a == 7 || pair.b == 7);
    bodies[7].asleep = true;
    EXPECT_TRUE(broad_phase.update(bodies, h).empty());
}

}  // namespace tumble::narrow_phase_test
