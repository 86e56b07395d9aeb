// Load estimates of piles small enough to compute by hand.
#include "sim/contact/model/load_estimate.h"
#include "sim/contact_scenes.h"

#include <gtest/gtest.h>

namespace tumble::load_estimate_test {
using namespace tumble::testing;

namespace {

/// Body 0 is fixed, the others have these masses; only the touching pairs count.
LoadEstimate pile(const std::vector<double>& masses, const std::vector<Manifold>& manifolds) {
    std::vector<Body> bodies(masses.size() + 1);
    bodies[0].type = BodyType::fixed;
    std::vector<std::uint32_t> members, all(manifolds.size());
    for (std::size_t i = 0; i < masses.size(); ++i) {
        bodies[i + 1].mass = masses[i];
        members.push_back(std::uint32_t(i + 1));
    }
    std::iota(all.begin(), all.end(), 0u);
    LoadEstimates loads(bodies.size());
    // A second evaluation gives the same: the first keeps no state.
    const LoadEstimate first = loads.find(bodies, manifolds, members, all),
                       second = loads.find(bodies, manifolds, members, all);
    EXPECT_EQ(first.ratio, second.ratio);
    EXPECT_EQ(first.levels, second.levels);
    return first;
}

}  // namespace

TEST(LoadEstimate, AStackRestsOnItsLowest) {
    for (const int n : {1, 2, 7, 100}) {
        std::vector<Manifold> manifolds;
        for (int i = 0; i < n; ++i) manifolds.push_back(touch(std::uint32_t(i), std::uint32_t(i + 1)));
        const LoadEstimate load = pile(std::vector<double>(std::size_t(n), 2.0), manifolds);
        EXPECT_DOUBLE_EQ(load.ratio, n);
        EXPECT_EQ(load.levels, n);
    }
}

TEST(LoadEstimate, HeavyOnLightAndLightOnHeavy) {
    EXPECT_DOUBLE_EQ(pile({1.0, 1e6}, {touch(0, 1), touch(1, 2)}).ratio, 1e6 + 1.0);
    EXPECT_DOUBLE_EQ(pile({1e6, 1.0}, {touch(0, 1), touch(1, 2)}).ratio, 1.0 + 1e-6);
    // Bodies beside each other do not load one another.
    EXPECT_DOUBLE_EQ(pile({1.0, 1e6}, {touch(0, 1), touch(0, 2), touch(1, 2)}).ratio, 1.0);
}

// Rows of n, n-1, ... 1, each on two of the row below. The two at the row's ends distribute their load to two, too:
// half each. The largest load is in the middle of the lowest row; three rows: (1/2 (1 + 1/2) twice) + 1 = 2.5.
TEST(LoadEstimate, APyramidOfThreeRows) {
    const std::vector<Manifold> manifolds = {touch(0, 1), touch(0, 2), touch(0, 3), touch(1, 4), touch(2, 4),
                                             touch(2, 5), touch(3, 5), touch(4, 6), touch(5, 6)};
    const LoadEstimate load = pile(std::vector<double>(6, 1.0), manifolds);
    EXPECT_DOUBLE_EQ(load.ratio, 2.5);
    EXPECT_EQ(load.levels, 3);
}

// Loads go only to neighbors nearer to a fixed body, and end there.
TEST(LoadEstimate, ABeamOnTwoPostsAndManyContactsOfOnePair) {
    const std::vector<Manifold> beam = {touch(0, 1), touch(0, 2), touch(1, 3), touch(2, 3)};
    EXPECT_DOUBLE_EQ(pile({1.0, 1.0, 10.0}, beam).ratio, 6.0);
    EXPECT_DOUBLE_EQ(pile({1.0, 1.0, 30.0}, beam).ratio, 16.0);
    EXPECT_EQ(pile({1.0, 1.0, 30.0}, beam).levels, 2);
    // Parts of compounds: three manifolds on one post, one on the other; three shares and one.
    const std::vector<Manifold> parts = {touch(0, 1), touch(0, 2), touch(1, 3), touch(1, 3), touch(1, 3), touch(2, 3)};
    EXPECT_DOUBLE_EQ(pile({1.0, 1.0, 40.0}, parts).ratio, 31.0);
    EXPECT_DOUBLE_EQ(pile({1.0, 0.1, 40.0}, parts).ratio, 101.0);
}

TEST(LoadEstimate, FreeBodiesCarryNothing) {
    const LoadEstimate load = pile({1.0, 5.0, 100.0}, {touch(1, 2), touch(2, 3)});
    EXPECT_EQ(load.ratio, 1.0);
    EXPECT_EQ(load.levels, 1);
}

}  // namespace tumble::load_estimate_test
