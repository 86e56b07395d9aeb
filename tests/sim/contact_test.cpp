// Contacts made of manifolds: what is derived, what is carried over from the step before; and islands against a flood fill.
#include "clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

using namespace tumble;
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

const Contact* find(const std::vector<Contact>& contacts, std::uint32_t a, std::uint32_t b, std::uint32_t part, std::uint64_t feature) {
    for (const Contact& c : contacts)
        if (c.a == a && c.b == b && c.part == part && c.feature == feature) return &c;
    return nullptr;
}

std::vector<Body> some_bodies(Random& random, int n) {
    std::vector<Body> bodies;
    for (int i = 0; i < n; ++i) bodies.push_back(random_body(random, BodyType::dynamic, 1.0, 2.0));
    return bodies;
}

}  // namespace

// The change of v_rel by a unit impulse along the normal, applied to the momenta, is the bracket of eq. 20.
TEST(MakeContacts, DerivesTheEffectiveMass) {
    Random random(111);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<Body> bodies{random_body(random, BodyType::dynamic, 0.1, 10.0),
                                 random_body(random, trial % 3 ? BodyType::dynamic : BodyType::fixed, 0.1, 10.0)};
        bodies[0].friction = 0.3;
        bodies[1].friction = 0.7;
        bodies[0].restitution = 0.2;
        bodies[1].restitution = 0.6;
        std::vector<Contact> contacts;
        make_contacts({random_manifold(random, bodies, 0, 1, 3)}, bodies, {}, contacts);
        ASSERT_EQ(contacts.size(), 3u);
        for (const Contact& c : contacts) {
            EXPECT_DOUBLE_EQ(c.friction, std::sqrt(0.21));
            EXPECT_EQ(c.restitution, 0.6);
            std::vector<Body> moved = bodies;
            add_impulse(c, c.normal, moved[0], moved[1]);
            for (Body& b : moved)
                if (b.dynamic()) b.derive();
            const double change = relative_velocity(c, moved[0], moved[1]) - relative_velocity(c, bodies[0], bodies[1]);
            EXPECT_NEAR(change, c.inverse_effective_mass, 1e-12 * c.inverse_effective_mass);
            // Applied to the velocities directly: the same.
            std::vector<Body> quick = bodies;
            apply_normal_to_velocities(1.0, c, quick[0], quick[1]);
            std::vector<Body> general = bodies;
            apply_to_velocities(c.normal, c, general[0], general[1]);
            for (std::size_t i = 0; i < 2; ++i) {
                EXPECT_LT((quick[i].velocity - moved[i].velocity).norm(), 1e-12);
                EXPECT_LT((quick[i].angular_velocity - moved[i].angular_velocity).norm(), 1e-11);
                EXPECT_LT((general[i].angular_velocity - moved[i].angular_velocity).norm(), 1e-11);
            }
            // No direction across the normal gives way more than the tangent mass says, and one gives way as much.
            double most = 0.0;
            const Vec3 t = c.normal.unitOrthogonal(), s = c.normal.cross(t);
            for (int k = 0; k < 180; ++k) {
                const double angle = k * 3.14159265 / 180.0;
                const Vec3 u = std::cos(angle) * t + std::sin(angle) * s;
                std::vector<Body> pushed = bodies;
                apply_to_velocities(u, c, pushed[0], pushed[1]);
                const auto slip = [&](const std::vector<Body>& two) {
                    return u.dot(two[1].point_velocity(c.arm_b) - two[0].point_velocity(c.arm_a));
                };
                most = std::max(most, slip(pushed) - slip(bodies));
            }
            EXPECT_LE(most, c.inverse_tangent_mass * (1.0 + 1e-9));
            EXPECT_GE(most, c.inverse_tangent_mass * 0.999);
        }
    }
}

TEST(MakeContacts, CarriesImpulsesOverByFeature) {
    Random random(112);
    const std::vector<Body> bodies = some_bodies(random, 4);
    std::vector<Contact> before, now;
    make_contacts({manifold(0, 1, 0, {5, 6, 7, 8}), manifold(0, 2, 3, {1}), manifold(0, 2, 9, {1, 2}), manifold(2, 3, 0, {4})},
                  bodies, {}, before);
    for (std::size_t i = 0; i < before.size(); ++i) {
        before[i].impulse = 10.0 + double(i);
        before[i].friction_impulse = Vec3(1.0 + double(i), 0.5, 0.0);   // its part along the normal must go
        before[i].impact = 7.0;
        before[i].bounce_velocity = 3.0;
    }
    // A point gone, the order changed, one new; a part gone and one new; a pair gone and one new.
    make_contacts({manifold(0, 1, 0, {8, 5, 99}), manifold(0, 2, 4, {1}), manifold(0, 2, 9, {2, 1}), manifold(1, 3, 0, {4}),
                   manifold(2, 3, 0, {4})},
                  bodies, before, now);
    ASSERT_EQ(now.size(), 8u);
    for (const Contact& c : now) {
        const Contact* old = find(before, c.a, c.b, c.part, c.feature);
        EXPECT_EQ(c.impulse, old ? old->impulse : 0.0) << c.a << c.b << c.part << " " << c.feature;
        EXPECT_LT((c.friction_impulse - Vec3(old ? old->friction_impulse.x() : 0.0, 0.0, 0.0)).norm(), 1e-15);
        EXPECT_EQ(c.impact, 0.0);   // of that step alone
        EXPECT_EQ(c.bounce_velocity, 0.0);
    }
    EXPECT_EQ(std::count_if(now.begin(), now.end(), [](const Contact& c) { return c.impulse > 0.0; }), 5);
}

// Random lists against the quadratic search.
TEST(MakeContacts, MatchesLikeBruteForce) {
    Random random(113);
    const std::vector<Body> bodies = some_bodies(random, 6);
    const auto random_list = [&] {
        std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> keys;
        for (int i = 0; i < 12; ++i) {
            const auto a = std::uint32_t(random.below(5));
            keys.emplace(a, a + 1 + std::uint32_t(random.below(int(5 - a))), std::uint32_t(random.below(3)));
        }
        std::vector<Manifold> list;
        for (const auto& [a, b, part] : keys) {
            std::set<std::uint64_t> features;
            for (int i = 0; i < 1 + random.below(4); ++i) features.insert(std::uint64_t(random.below(6)));
            list.push_back(manifold(a, b, part, {features.begin(), features.end()}));
        }
        return list;
    };
    std::vector<Contact> before, now;
    for (int trial = 0; trial < 300; ++trial) {
        make_contacts(random_list(), bodies, before, now);
        for (const Contact& c : now) {
            const Contact* old = find(before, c.a, c.b, c.part, c.feature);
            ASSERT_EQ(c.impulse, old ? old->impulse : 0.0);
        }
        for (Contact& c : now) c.impulse = random(0.1, 1.0);
        before.swap(now);
    }
}

TEST(Islands, LikeAFloodFill) {
    Random random(114);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<Body> bodies(std::size_t(2 + random.below(40)));
        for (Body& b : bodies) b.type = random.below(5) == 0 ? (random.below(2) ? BodyType::fixed : BodyType::kinematic) : BodyType::dynamic;
        const int n = int(bodies.size());
        std::vector<Contact> contacts;
        for (int i = 0; i < random.below(2 * n); ++i) {
            Contact c;
            for (Vec3* v : {&c.normal, &c.arm_a, &c.arm_b, &c.turn_a, &c.turn_b}) v->setZero();
            c.a = std::uint32_t(random.below(n));
            c.b = std::uint32_t(random.below(n));
            if (c.a == c.b || (!bodies[c.a].dynamic() && !bodies[c.b].dynamic())) continue;
            contacts.push_back(c);
        }
        // Spread labels until nothing changes.
        std::vector<int> label(bodies.size());
        for (int i = 0; i < n; ++i) label[std::size_t(i)] = i;
        for (bool changed = true; changed;) {
            changed = false;
            for (const Contact& c : contacts) {
                if (!bodies[c.a].dynamic() || !bodies[c.b].dynamic() || label[c.a] == label[c.b]) continue;
                label[c.a] = label[c.b] = std::min(label[c.a], label[c.b]);
                changed = true;
            }
        }
        std::map<int, Island> expected;   // ascending by lowest body
        std::set<std::uint32_t> touched;
        for (const Contact& c : contacts) touched.insert({c.a, c.b});
        for (const std::uint32_t i : touched)
            if (bodies[i].dynamic()) expected[label[i]].bodies.push_back(i);
        for (std::uint32_t k = 0; k < contacts.size(); ++k)
            expected[label[bodies[contacts[k].a].dynamic() ? contacts[k].a : contacts[k].b]].contacts.push_back(k);

        const std::vector<Island> found = find_islands(contacts, bodies);
        ASSERT_EQ(found.size(), expected.size());
        std::size_t i = 0;
        for (const auto& [root, island] : expected) {
            EXPECT_EQ(found[i].bodies, island.bodies);
            EXPECT_EQ(found[i].contacts, island.contacts);
            ++i;
        }
    }
}
