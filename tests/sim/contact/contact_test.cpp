// Contacts made of manifolds, and impulse matching with the last step.
#include "sim/clusters.h"
#include "sim/geometry/persistent_manifold.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace tumble::contact_test {
using namespace tumble::testing;

namespace {

Manifold manifold(std::uint32_t a, std::uint32_t b, std::uint32_t part, const std::vector<std::uint64_t>& features) {
    Manifold m;
    m.a = a;
    m.b = b;
    m.part = part;
    m.normal = Vec3::UnitY();
    for (const std::uint64_t f : features) m.points[std::size_t(m.count++)].feature = f;
    return m;
}

std::vector<Body> some_bodies(Random& random, int n) {
    std::vector<Body> bodies;
    for (int i = 0; i < n; ++i) bodies.push_back(random_body(random, BodyType::dynamic, 1.0, 2.0));
    return bodies;
}

}  // namespace

// The change of v_rel by a unit impulse along the normal, applied to the momenta, is the bracket of eq. 20: the squared
// length of a contact's row in an impact.
TEST(MakeContacts, RowsHaveTheBracketOfEquation20) {
    Random random(111);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<Body> bodies{random_body(random, BodyType::dynamic, 0.1, 10.0),
                                 random_body(random, trial % 3 ? BodyType::dynamic : BodyType::fixed, 0.1, 10.0)};
        bodies[0].friction = 0.3;
        bodies[1].friction = 0.7;
        bodies[0].restitution = 0.2;
        bodies[1].restitution = 0.6;
        std::vector<Contact> contacts;
        make_contacts({random_manifold(random, bodies, 0, 1, 3)}, bodies, contacts);
        ASSERT_EQ(contacts.size(), 3u);
        Island island{{0}, {0, 1, 2}};
        if (bodies[1].dynamic()) island.bodies.push_back(1);
        const ImpactSystem cluster(island, contacts, bodies);
        for (std::size_t i = 0; i < 3; ++i) {
            const Contact& c = contacts[i];
            EXPECT_DOUBLE_EQ(c.friction, std::sqrt(0.21));
            EXPECT_EQ(c.restitution, 0.6);
            std::vector<Body> moved = bodies;
            add_impulse(c, c.normal, moved[0], moved[1]);
            for (Body& b : moved)
                if (b.dynamic()) b.derive();
            const double before = relative_velocity(c, bodies[0], bodies[1]);
            const double bracket = cluster.length(i) * cluster.length(i);
            EXPECT_NEAR(relative_velocity(c, moved[0], moved[1]) - before, bracket, 1e-12 * bracket);
            EXPECT_NEAR(cluster.speed(i), before, 1e-12);
        }
    }
}

// In the order of the manifolds and of their points; contacts of a single manifold are appended.
// Impacts of heaps write and read lists of them in each step: with 344 bytes, 5 % more time.
static_assert(sizeof(Contact) <= 200, "members that few readers need have lists of their own");

TEST(MakeContacts, KeepsTheManifoldsOrder) {
    Random random(112);
    const std::vector<Body> bodies = some_bodies(random, 4);
    const std::vector<Manifold> manifolds{manifold(0, 1, 0, {5, 6, 7, 8}), manifold(0, 2, 3, {1}),
                                          manifold(2, 3, 9, {4, 2})};
    std::vector<Contact> contacts(3);  // of the last step: they are removed
    make_contacts(manifolds, bodies, contacts);
    ASSERT_EQ(contacts.size(), 7u);
    for (const Manifold& m : manifolds) add_contacts(m, bodies, contacts);
    ASSERT_EQ(contacts.size(), 14u);
    std::size_t next = 0;
    for (int round = 0; round < 2; ++round)
        for (const Manifold& m : manifolds)
            for (int i = 0; i < m.count; ++i) {
                const Contact& c = contacts[next++];
                EXPECT_EQ(std::tuple(c.a, c.b, c.part, c.feature),
                          std::tuple(m.a, m.b, m.part, m.points[std::size_t(i)].feature));
                EXPECT_EQ(c.impact, 0.0);  // of that step alone
                EXPECT_EQ(c.bounce_velocity, 0.0);
            }
}

// Impulses of earlier steps: to points of the same feature; to other points that of the nearest remaining old point,
// within reach; the remainder to the nearest points of all, so that no load is lost.
TEST(CarryOver, ByFeatureThenByPlace) {
    Manifold before = manifold(0, 1, 0, {5, 6, 7, 8}), now = manifold(0, 1, 0, {8, 5, 99, 100});
    for (int i = 0; i < 4; ++i) {
        before.points[std::size_t(i)].impulse = 10.0 + i;
        before.points[std::size_t(i)].position = Vec3(i, 0.0, 0.0);
    }
    before.tangent = Vec3::UnitX();
    before.friction[0] = 1.0;
    before.friction[1] = 2.0;
    before.torsion = 3.0;
    now.points[0].position = Vec3(1.0, 0.0, 0.0);  // the old place of feature 6: its own feature counts all the same
    now.points[2].position = Vec3(2.1, 0.0, 0.0);
    now.points[3].position = Vec3(1.0, 0.0, 0.6);
    match_impulses(before, 0.5, now);
    EXPECT_EQ(now.points[0].impulse, 13.0 + 11.0);  // and that of feature 6, which is gone
    EXPECT_EQ(now.points[1].impulse, 10.0);
    EXPECT_EQ(now.points[2].impulse, 12.0);
    EXPECT_EQ(now.points[3].impulse, 0.0);  // no old point near
    EXPECT_EQ(now.tangent, Vec3::UnitX());
    EXPECT_EQ(now.friction[0], 1.0);
    EXPECT_EQ(now.friction[1], 2.0);
    EXPECT_EQ(now.torsion, 3.0);

    // Another side of the body carries the load: the old impulses do not apply to it.
    Manifold turned = manifold(0, 1, 0, {5, 99});
    turned.normal = before.normal.unitOrthogonal();
    turned.points[1].position = Vec3(9.0, 0.0, 0.0);
    match_impulses(before, 0.5, turned);
    EXPECT_EQ(turned.points[0].impulse, 10.0);
    EXPECT_EQ(turned.points[1].impulse, 0.0);
}

// Random features, far apart: like the quadratic search, no old impulse twice, and none lost.
TEST(CarryOver, MatchesLikeBruteForce) {
    Random random(113);
    for (int trial = 0; trial < trials(300); ++trial) {
        const auto random_manifold = [&] {
            std::set<std::uint64_t> features;
            for (int i = 0; i < 1 + random.below(4); ++i) features.insert(std::uint64_t(random.below(6)));
            std::vector<std::uint64_t> list(features.begin(), features.end());
            if (random.below(2)) std::reverse(list.begin(), list.end());
            return manifold(0, 1, 0, list);
        };
        Manifold before = random_manifold(), now = random_manifold();
        for (int i = 0; i < before.count; ++i) before.points[std::size_t(i)].impulse = random(0.1, 1.0);
        match_impulses(before, 0.0, now);
        double carried = 0.0, built = 0.0;
        for (int i = 0; i < before.count; ++i) built += before.points[std::size_t(i)].impulse;
        for (int i = 0; i < now.count; ++i) {
            double expected = 0.0;
            for (int k = 0; k < before.count; ++k)
                if (before.points[std::size_t(k)].feature == now.points[std::size_t(i)].feature)
                    expected = before.points[std::size_t(k)].impulse;
            EXPECT_GE(now.points[std::size_t(i)].impulse, expected);
            carried += now.points[std::size_t(i)].impulse;
        }
        EXPECT_NEAR(carried, built, 1e-12);
    }
}

}  // namespace tumble::contact_test
