// The tree finds exactly what a loop over all items finds.
#include "sim/math/bounds_tree.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::bounds_tree_test {
using namespace tumble::testing;

namespace {

void expect_like_brute_force(const std::vector<Bounds>& items, const std::vector<Bounds>& queries) {
    const BoundsTree tree(items);
    Bounds all;
    for (const Bounds& b : items) all.add(b);
    EXPECT_EQ(tree.bounds().min, all.min);
    EXPECT_EQ(tree.bounds().max, all.max);
    for (const Bounds& q : queries) {
        std::vector<std::uint32_t> found, expected;
        tree.query(q, [&](std::uint32_t i) { found.push_back(i); });
        for (std::uint32_t i = 0; i < items.size(); ++i)
            if (items[i].overlaps(q)) expected.push_back(i);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected) << items.size();
    }
}

Bounds random_box(Random& random, double place, double size) {
    const Vec3 at = random.vector(place), half = random.vector(size).cwiseAbs();
    return {at - half, at + half};
}

}  // namespace

TEST(BoundsTree, RandomBoxes) {
    Random random(71);
    for (const int n : {1, 2, 3, 4, 5, 8, 9, 17, 100, 1000}) {
        std::vector<Bounds> items, queries;
        for (int i = 0; i < n; ++i) items.push_back(random_box(random, 10.0, i % 10 == 0 ? 8.0 : 0.5));
        for (int i = 0; i < 100; ++i) queries.push_back(random_box(random, 12.0, i % 3 == 0 ? 6.0 : 0.3));
        expect_like_brute_force(items, queries);
    }
}

TEST(BoundsTree, EmptyTreeHasNothing) {
    int visits = 0;
    const Bounds everything{Vec3::Constant(-1e300), Vec3::Constant(1e300)};
    BoundsTree().query(everything, [&](std::uint32_t) { ++visits; });
    BoundsTree(std::vector<Bounds>{}).query(everything, [&](std::uint32_t) { ++visits; });
    EXPECT_EQ(visits, 0);
    EXPECT_TRUE(BoundsTree().bounds().empty());
}

// Equal, flat, pointlike, collinear and nested boxes: median splits cannot separate them.
TEST(BoundsTree, DegenerateBoxes) {
    Random random(72);
    std::vector<Bounds> alike(1000, Bounds{Vec3::Zero(), Vec3::Ones()}), points, line, nested, queries;
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = random.vector(1.0);
        points.push_back({p, p});
        line.push_back({Vec3(i, 0.0, 0.0), Vec3(i + 1.0, 0.0, 0.0)});
        nested.push_back({Vec3::Constant(-i), Vec3::Constant(i)});
    }
    for (int i = 0; i < 50; ++i) queries.push_back(random_box(random, 3.0, 1.0));
    queries.push_back({Vec3::Ones(), Vec3::Ones()});                        // touches a corner: overlap
    queries.push_back({Vec3::Constant(1.0 + 1e-15), Vec3::Constant(2.0)});  // beyond it by one digit: no overlap
    queries.push_back({Vec3(3.0, -1.0, -1.0), Vec3(3.0, 1.0, 1.0)});        // through the boundary between boxes
    queries.push_back(Bounds{});                                            // empty
    for (const auto& items : {alike, points, line, nested}) expect_like_brute_force(items, queries);
}

TEST(BoundsTree, InfiniteBoxes) {
    const double inf = std::numeric_limits<double>::infinity();
    std::vector<Bounds> items(9, Bounds{Vec3::Constant(-inf), Vec3::Constant(inf)});
    items.push_back({Vec3::Zero(), Vec3::Ones()});
    expect_like_brute_force(items, {{Vec3::Constant(5.0), Vec3::Constant(6.0)}, {Vec3::Zero(), Vec3::Ones()}});
}

TEST(BoundsTree, SameInputSameOrder) {
    Random random(73);
    std::vector<Bounds> items;
    for (int i = 0; i < 300; ++i) items.push_back(random_box(random, 3.0, 1.0));
    std::vector<std::uint32_t> first, second;
    BoundsTree(items).query(items[0], [&](std::uint32_t i) { first.push_back(i); });
    BoundsTree(items).query(items[0], [&](std::uint32_t i) { second.push_back(i); });
    EXPECT_EQ(first, second);
}

}  // namespace tumble::bounds_tree_test
