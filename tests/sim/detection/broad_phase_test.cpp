// Pairs of the broad phase against all pairs, over random motion, with sleeping, fixed and kinematic bodies.
#include "sim/detection/broad_phase.h"
#include "sim/detection/narrow_phase.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::broad_phase_test {
using namespace tumble::testing;

namespace {

constexpr double h = 1e-3;

Body body_of(Random& random, int kind) {
    Body body;
    if (kind == 0) {
        body.type = BodyType::fixed;
        body.collider = HalfSpace{random.direction(), random(-4.0, -2.0)};
    } else if (kind < 4) {
        body.type = BodyType::fixed;
        body.collider = kind == 1 ? CollisionShape(Ball{random(0.2, 2.0)})
                                  : box_of(random.vector(2.0).cwiseAbs() + Vec3::Constant(0.1));
    } else {
        if (kind % 3 == 0)
            body.collider = Ball{random(0.1, 0.5)};
        else
            body.collider = box_of(random.vector(0.8).cwiseAbs() + Vec3::Constant(0.05));
        if (kind % 11 == 5) {
            body.type = BodyType::kinematic;
            body.track = std::make_shared<KeyframeTrack>(std::vector<Keyframe>{{}}, Interpolation::linear);
        }
    }
    body.radius = bounding_radius(body.collider);
    body.position = random.vector(3.0);
    body.orientation = random.turn();
    body.rotation = body.orientation.toRotationMatrix();
    return body;
}

bool within(const Body& a, const Body& b) { return bounds_of_step(a, h).overlaps(bounds_of_step(b, h)); }

}  // namespace

TEST(BroadPhase, HoldsAllPairsThatMayTouch) {
    Random random(81);
    for (int scene = 0; scene < 6; ++scene) {
        std::vector<Body> bodies;
        for (int i = 0; i < 60; ++i) bodies.push_back(body_of(random, (i * 7) % 40));
        BroadPhase broad_phase;
        CollisionScratch scratch;
        std::size_t most = 0;
        for (int step = 0; step < trials(120); ++step) {
            for (Body& body : bodies) {
                if (!body.moves() || body.asleep) continue;
                body.velocity =
                    0.98 * body.velocity + random.vector(step % 40 == 0 ? 40.0 : 2.0);  // with an occasional kick
                body.angular_velocity = random.vector(20.0);
            }
            const std::vector<BroadPhase::Pair> pairs = broad_phase.update(bodies, h);
            most = std::max(most, pairs.size());
            ASSERT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
            ASSERT_TRUE(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end()) << "a pair twice";
            for (std::uint32_t i = 0; i < bodies.size(); ++i)
                for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
                    const Body &a = bodies[i], &b = bodies[j];
                    const bool listed = std::binary_search(pairs.begin(), pairs.end(), BroadPhase::Pair{i, j});
                    if (!a.dynamic() && !b.dynamic()) {
                        EXPECT_FALSE(listed);
                        continue;
                    }
                    const bool idle = (!a.moves() || a.asleep) && (!b.moves() || b.asleep);
                    EXPECT_FALSE(listed && idle);
                    if (listed || idle) continue;
                    if (std::holds_alternative<HalfSpace>(a.collider) ||
                        std::holds_alternative<HalfSpace>(b.collider)) {
                        std::vector<Manifold> out;
                        const double margin = 0.02 * (a.moves() ? a.radius : b.radius);
                        collide(a.collider, b.collider, {a.pose(), b.pose(), margin, scratch, out});
                        EXPECT_TRUE(out.empty()) << i << " " << j;
                    } else {
                        EXPECT_FALSE(within(a, b)) << i << " " << j << " step " << step;
                    }
                }
            for (Body& body : bodies) {
                if (random(0.0, 1.0) < 0.02) {
                    body.asleep = body.dynamic() && !body.asleep;
                    if (!body.asleep) broad_phase.bodies_woke();
                }
                if (!body.moves() || body.asleep) continue;
                body.position += h * 5.0 * body.velocity;
                body.orientation = (Quat(Eigen::AngleAxisd(0.01, random.direction())) * body.orientation).normalized();
                body.rotation = body.orientation.toRotationMatrix();
            }
        }
        EXPECT_GT(most, 20u);
        EXPECT_LT(most, 900u);  // of 1770: some are excluded
    }
}

TEST(BroadPhase, ThreadsFindTheSamePairs) {
    Random random(85);
    std::vector<Body> bodies;
    for (int i = 0; i < 800; ++i) {
        bodies.push_back(body_of(random, i < 4 ? i : 4 + i % 36));
        bodies.back().position *= 3.0;
    }
    ThreadPool pool(3);
    BroadPhase alone, together;
    for (int step = 0; step < 20; ++step) {
        for (Body& body : bodies) {
            if (!body.moves()) continue;
            body.velocity = random.vector(step % 4 == 0 ? 60.0 : 5.0);
            body.position += h * 5.0 * body.velocity;
        }
        const std::vector<BroadPhase::Pair> expected = alone.update(bodies, h);
        ASSERT_GT(expected.size(), 200u);
        ASSERT_EQ(together.update(bodies, h, &pool), expected) << step;
    }
}

// For a measurement every pair counts, asleep or not.
TEST(BroadPhase, PairsOfSleepingBodies) {
    Random random(84);
    std::vector<Body> bodies;
    for (int i = 0; i < 60; ++i) bodies.push_back(body_of(random, i % 40));
    BroadPhase awake, all(BroadPhase::Pairs::all), still_all(BroadPhase::Pairs::all);
    const std::vector<BroadPhase::Pair> pairs = awake.update(bodies, h);
    EXPECT_EQ(all.update(bodies, h), pairs);
    for (Body& body : bodies) body.asleep = body.dynamic();
    std::erase_if(bodies, [](const Body& body) { return body.track != nullptr; });
    EXPECT_TRUE(BroadPhase().update(bodies, h).empty());
    EXPECT_GT(still_all.update(bodies, h).size(), 20u);
}

TEST(BroadPhase, NoBodiesAndOneBody) {
    BroadPhase none, one;
    EXPECT_TRUE(none.update({}, h).empty());
    Random random(82);
    const std::vector<Body> bodies{body_of(random, 6)};
    EXPECT_TRUE(one.update(bodies, h).empty());
    EXPECT_TRUE(one.update(bodies, h).empty());
}

// The narrow phase over threads: the same manifolds, in the same order, for any number of threads.
TEST(NarrowPhase, ThreadsChangeNothing) {
    Random random(83);
    std::vector<Body> bodies;
    for (int i = 0; i < 150; ++i) bodies.push_back(body_of(random, i % 40));
    bodies.push_back(Body{});
    TriangleMesh mesh = grid_mesh(12, 4.0, 0.1);
    bodies.back().type = BodyType::fixed;
    bodies.back().collider = surface_of(mesh);
    BroadPhase broad_phase;
    const auto pairs = broad_phase.update(bodies, h);
    ASSERT_GT(pairs.size(), 200u);
    std::vector<Manifold> of_round[3];  // refreshed manifolds of the same poses differ in the last digits
    for (const int threads : {1, 2, 4}) {
        ThreadPool pool(threads);
        NarrowPhase narrow_phase(threads);
        for (int round = 0; round < 3; ++round) {
            const auto& found = narrow_phase.find(pairs, bodies, h, pool);
            std::vector<Manifold>& expected = of_round[round];
            if (expected.empty()) expected = found;
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                const Manifold &m = found[i], &e = expected[i];
                EXPECT_TRUE(m.a == e.a && m.b == e.b && m.part == e.part && m.count == e.count);
                EXPECT_EQ(m.normal, e.normal);
                EXPECT_EQ(m.points[0].position, e.points[0].position);
                if (i == 0) continue;
                const Manifold& before = found[i - 1];
                EXPECT_LE(std::make_tuple(before.a, before.b, before.part), std::make_tuple(m.a, m.b, m.part));
            }
        }
    }
}

}  // namespace tumble::broad_phase_test
