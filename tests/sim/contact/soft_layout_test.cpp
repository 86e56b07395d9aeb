// The soft solver's lanes: each manifold has one, no color touches a body twice, and bodies that touch many others fill
// the lanes too.
#include "sim/contact/soft/soft_layout.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace tumble::soft_layout_test {
namespace {

constexpr std::size_t lanes = 16;

/// Bodies in one place, each of which touches each other one.
struct Crowd {
    explicit Crowd(std::uint32_t count) : bodies(count), slot(count, 0) {
        for (std::uint32_t a = 0; a < count; ++a) {
            batch.bodies.push_back(a);
            bodies[a].position.x() = 1e-3 * a;
            for (std::uint32_t b = a + 1; b < count; ++b) {
                batch.pairs.push_back({a, b});
                batch.manifolds.push_back(std::uint32_t(manifolds.size()));
                manifolds.emplace_back().count = 1;
            }
        }
        batch.island_ends = {count};
        layout.open(batch, bodies, slot, 1);
        layout.color(batch, bodies, manifolds, slot, 0, 1);
        layout.close(batch, slot, lanes);
    }

    template <class Visit>
    void each_in_color(std::size_t color, Visit&& visit) const {
        for (std::size_t lane = lanes * layout.first_group(color); lane < lanes * layout.first_group(color + 1); ++lane)
            if (layout.manifold(lane) != SoftLayout::none) visit(layout.manifold(lane));
    }
    std::size_t colors() const { return layout.first_color(layout.blocks().size() + 1); }

    IslandBatch batch;
    std::vector<Body> bodies;
    std::vector<Manifold> manifolds;
    std::vector<std::uint32_t> slot;
    SoftLayout layout;
};

TEST(SoftLayout, ACrowdFillsTheLanes) {
    for (const std::uint32_t count : {200u, 400u}) {
        const Crowd crowd(count);
        EXPECT_LT(double(lanes * crowd.layout.groups()), 1.6 * double(crowd.manifolds.size())) << count;
        std::vector<int> seen(crowd.manifolds.size(), 0);
        for (std::size_t color = 0; color < crowd.colors(); ++color) {
            std::set<std::uint32_t> touched;
            crowd.each_in_color(color, [&](std::uint32_t m) {
                ++seen[m];
                EXPECT_TRUE(touched.insert(crowd.batch.pairs[m].a).second) << color;
                EXPECT_TRUE(touched.insert(crowd.batch.pairs[m].b).second) << color;
            });
        }
        for (const int times : seen) ASSERT_EQ(times, 1) << count;
    }
}

// Manifolds without a free color are solved after the others, in their order: it decides the result.
TEST(SoftLayout, ManifoldsOfOneBodyBeyondTheColorsKeepTheirOrder) {
    const Crowd crowd(120);
    ASSERT_EQ(crowd.layout.blocks().size(), 1u);  // so that no color is of manifolds between blocks
    std::vector<std::uint32_t> last(crowd.bodies.size(), 0);
    std::size_t late = 0;
    for (std::size_t color = crowd.layout.first_color(1); color < crowd.colors(); ++color)
        crowd.each_in_color(color, [&](std::uint32_t m) {
            for (const std::uint32_t body : {crowd.batch.pairs[m].a, crowd.batch.pairs[m].b}) {
                EXPECT_GE(m, last[body]);
                last[body] = m;
            }
            ++late;
        });
    EXPECT_GT(late, crowd.manifolds.size() / 4);
}

}  // namespace
}  // namespace tumble::soft_layout_test
