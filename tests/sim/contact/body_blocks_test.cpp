// Islands in blocks: every body once, blocks small enough, and the blocks of an island independent of other islands.
#include "sim/contact/soft/soft_layout.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace tumble::body_blocks_test {
using tumble::testing::Random;

namespace {

constexpr std::size_t most = 32;

std::vector<std::vector<std::uint32_t>> blocks_of(const std::vector<std::vector<std::uint32_t>>& islands,
                                                  const std::vector<Body>& bodies) {
    BodyBlocks blocks(most);
    blocks.add(islands.front(), bodies);
    blocks.clear();  // removes all blocks
    for (const auto& island : islands) blocks.add(island, bodies);
    std::vector<std::vector<std::uint32_t>> found;
    for (std::size_t b = 0; b < blocks.size(); ++b)
        found.emplace_back(blocks.order().begin() + std::ptrdiff_t(blocks.first(b)),
                           blocks.order().begin() + std::ptrdiff_t(blocks.first(b + 1)));
    EXPECT_EQ(blocks.first(blocks.size()), blocks.order().size());
    return found;
}

}  // namespace

TEST(BodyBlocks, EveryBodyOnceInBlocksThatAreSmallEnough) {
    Random random(81);
    for (int trial = 0; trial < 100; ++trial) {
        std::vector<std::vector<std::uint32_t>> islands(std::size_t(1 + random.below(8)));
        std::vector<Body> bodies;
        for (auto& island : islands)
            for (int i = random.below(2) ? 1 + random.below(200) : 1 + random.below(20); i > 0; --i) {
                island.push_back(std::uint32_t(bodies.size()));
                bodies.emplace_back().position =
                    random.below(3) ? random.vector(5.0) : Vec3::Ones();  // some all in one place
            }
        std::set<std::uint32_t> seen;
        for (const auto& block : blocks_of(islands, bodies)) {
            ASSERT_FALSE(block.empty());
            ASSERT_LE(block.size(), most);
            ASSERT_TRUE(std::is_sorted(block.begin(), block.end()));
            for (const std::uint32_t i : block) ASSERT_TRUE(seen.insert(i).second);
        }
        ASSERT_EQ(seen.size(), bodies.size());
        // The blocks of a large island are the same as for the island alone; small islands are never cut.
        const auto all = blocks_of(islands, bodies);
        for (const auto& island : islands) {
            if (island.size() <= most) {
                EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const auto& b) {
                    return std::includes(b.begin(), b.end(), island.begin(), island.end());
                }));
                continue;
            }
            for (const auto& block : blocks_of({island}, bodies))
                EXPECT_NE(std::find(all.begin(), all.end(), block), all.end());
        }
    }
}

// A row is cut along its length: blocks are segments of it.
TEST(BodyBlocks, NeighborsShareABlock) {
    std::vector<Body> bodies(100);
    std::vector<std::uint32_t> island;
    for (std::uint32_t i = 0; i < 100; ++i) {
        bodies[i].position = Vec3(0.1 * (i % 3), 0.0, double((37 * i) % 100));
        island.push_back(i);
    }
    for (const auto& block : blocks_of({island}, bodies)) {
        double low = 1e9, high = -1e9;
        for (const std::uint32_t i : block) {
            low = std::min(low, bodies[i].position.z());
            high = std::max(high, bodies[i].position.z());
        }
        EXPECT_EQ(high - low, double(block.size() - 1));
    }
}

}  // namespace tumble::body_blocks_test
