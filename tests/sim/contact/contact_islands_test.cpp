// Islands against a flood fill over all pairs of bodies.
#include "sim/contact/model/contact_islands.h"
#include "sim/contact_scenes.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

namespace tumble::contact_islands_test {
using namespace tumble::testing;

namespace {

bool takes_part(const Body& body) { return body.dynamic() && !body.asleep && !body.flying; }
bool apart(const Body& body) { return body.dynamic() && (body.asleep || body.flying); }

struct Flood {
    std::vector<int> label;  // by body; -1: of no island
    std::vector<int> manifold_label;
};

/// Spreads the lowest body's label over all touching bodies until nothing changes.
Flood flood(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies) {
    Flood f{std::vector<int>(bodies.size(), -1), std::vector<int>(manifolds.size(), -1)};
    const auto counts = [&](const Manifold& m) { return !apart(bodies[m.a]) && !apart(bodies[m.b]); };
    for (const Manifold& m : manifolds)
        for (const std::uint32_t i : {m.a, m.b})
            if (counts(m) && takes_part(bodies[i])) f.label[i] = int(i);
    for (bool changed = true; changed;) {
        changed = false;
        for (const Manifold& m : manifolds) {
            if (!counts(m) || !takes_part(bodies[m.a]) || !takes_part(bodies[m.b])) continue;
            const int low = std::min(f.label[m.a], f.label[m.b]);
            changed = changed || f.label[m.a] != low || f.label[m.b] != low;
            f.label[m.a] = f.label[m.b] = low;
        }
    }
    for (std::size_t k = 0; k < manifolds.size(); ++k)
        if (counts(manifolds[k]))
            f.manifold_label[k] =
                takes_part(bodies[manifolds[k].a]) ? f.label[manifolds[k].a] : f.label[manifolds[k].b];
    return f;
}

}  // namespace

TEST(ContactIslands, AgreeWithAFloodFill) {
    Random random(5);
    constexpr std::size_t n = 40;
    ContactIslands islands(n);  // shared by all rounds: an earlier round must not affect a later one
    for (int trial = 0; trial < trials(2000); ++trial) {
        std::vector<Body> bodies(n);
        std::vector<std::uint32_t> awake;
        for (std::uint32_t i = 0; i < n; ++i) {
            const int kind = random.below(10);
            bodies[i].type = kind == 0 ? BodyType::fixed : kind == 1 ? BodyType::kinematic : BodyType::dynamic;
            bodies[i].asleep = kind == 2;
            bodies[i].flying = kind == 3;
            if (bodies[i].dynamic() && !bodies[i].asleep && !bodies[i].flying) awake.push_back(i);
        }
        std::vector<Manifold> manifolds;
        for (int k = random.below(50); k > 0; --k) {
            const auto a = std::uint32_t(random.below(n)), b = std::uint32_t(random.below(n));
            if (a != b && (bodies[a].dynamic() || bodies[b].dynamic()))
                manifolds.push_back(touch(std::min(a, b), std::max(a, b)));
        }
        islands.find(body_pairs(manifolds), bodies, awake);
        const Flood expected = flood(manifolds, bodies);
        std::size_t in_islands = 0, manifolds_in_islands = 0;
        int last = -1;
        for (std::size_t k = 0; k < islands.size(); ++k) {
            const auto members = islands.bodies(k);
            ASSERT_FALSE(members.empty());
            const int label = int(members[0]);
            ASSERT_GT(label, last);  // islands are ordered by their lowest body
            last = label;
            for (std::size_t i = 0; i < members.size(); ++i) {
                ASSERT_EQ(expected.label[members[i]], label);
                if (i > 0) {
                    ASSERT_GT(members[i], members[i - 1]);
                }
            }
            for (const std::uint32_t m : islands.manifolds(k)) ASSERT_EQ(expected.manifold_label[m], label);
            in_islands += members.size();
            manifolds_in_islands += islands.manifolds(k).size();
        }
        ASSERT_EQ(in_islands, std::size_t(std::count_if(expected.label.begin(), expected.label.end(),
                                                        [](int l) { return l >= 0; })));
        ASSERT_EQ(manifolds_in_islands,
                  std::size_t(std::count_if(expected.manifold_label.begin(), expected.manifold_label.end(),
                                            [](int l) { return l >= 0; })));
    }
}

TEST(ContactIslands, FixedAndKinematicBodiesConnectNothing) {
    std::vector<Body> bodies(4);
    bodies[0].type = BodyType::fixed;
    bodies[1].type = BodyType::kinematic;
    ContactIslands islands(4);
    islands.find(body_pairs({touch(0, 2), touch(0, 3), touch(1, 2), touch(1, 3)}), bodies,
                 std::vector<std::uint32_t>{2, 3});
    ASSERT_EQ(islands.size(), 2u);
    EXPECT_EQ(islands.manifolds(0).size(), 2u);
    EXPECT_EQ(islands.manifolds(1).size(), 2u);
}

TEST(ContactIslands, NoContactsNoIslands) {
    std::vector<Body> bodies(3);
    ContactIslands islands(3);
    islands.find({}, bodies, std::vector<std::uint32_t>{0, 1, 2});
    EXPECT_EQ(islands.size(), 0u);
}

}  // namespace tumble::contact_islands_test
