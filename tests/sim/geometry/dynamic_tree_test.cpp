// The dynamic tree against a test of every box, while boxes are added, moved and removed; the event queue against
// sorting.
#include "sim/geometry/dynamic_tree.h"
#include "sim/event_driven/event_queue.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace tumble::dynamic_tree_test {
using namespace tumble::testing;

namespace {

Bounds random_box(Random& random) {
    const Vec3 center = random.vector(10.0), half(random(0.0, 1.0), random(0.0, 1.0), random(0.0, 1.0));
    return {center - half, center + half};
}

}  // namespace

TEST(DynamicTree, FindsOverlappingBoxes) {
    Random random(7);
    DynamicTree tree;
    std::map<std::uint32_t, Bounds> boxes;
    for (int turn = 0; turn < 3000; ++turn) {
        const auto item = std::uint32_t(random(0.0, 200.0));
        if (random(0.0, 1.0) < 0.3) {
            tree.remove(item);
            boxes.erase(item);
        } else {
            // Far away, or slightly displaced.
            const Vec3 little = random.vector(0.3);
            const bool stays = boxes.count(item) == 1 && random(0.0, 1.0) < 0.5;
            boxes[item] = stays ? Bounds{boxes[item].min + little, boxes[item].max + little} : random_box(random);
            tree.set(item, boxes[item]);
        }
        EXPECT_EQ(tree.holds(item), boxes.count(item) == 1);
        const Bounds query = random_box(random).grown(random(0.0, 3.0));
        std::vector<std::uint32_t> found, expected;
        DynamicTree::Stack stack;
        tree.query(query, stack, [&](std::uint32_t i) { found.push_back(i); });
        std::sort(found.begin(), found.end());
        for (const auto& [i, box] : boxes)
            if (box.overlaps(query)) expected.push_back(i);
        ASSERT_EQ(found, expected);
    }
}

TEST(EventQueue, GivesTheEarliestAndTheLowestBody) {
    Random random(7);
    EventQueue queue(50);
    std::map<std::uint32_t, EventTime> moments;
    for (int turn = 0; turn < 5000; ++turn) {
        const auto body = std::uint32_t(random(0.0, 50.0));
        if (random(0.0, 1.0) < 0.2) {
            queue.remove(body);
            moments.erase(body);
        } else {
            // Few different times, so that many are equal.
            moments[body] = {std::int64_t(random(0.0, 3.0)), 0.25 * std::floor(random(0.0, 4.0))};
            queue.set(body, moments[body]);
        }
        ASSERT_EQ(queue.empty(), moments.empty());
        if (moments.empty()) continue;
        const auto first = std::min_element(moments.begin(), moments.end(), [](const auto& a, const auto& b) {
            return std::pair(a.second, a.first) < std::pair(b.second, b.first);
        });
        ASSERT_EQ(queue.first(), first->first);
        ASSERT_EQ(queue.first_moment(), first->second);
    }
}

TEST(EventTime, KeepsItsDigitsFarFromTheStart) {
    const StepClock clock{60.0, 16};
    const EventTime a{3'456'000'000, 1e-4}, b{3'456'000'001, 3e-4};  // after a thousand hours
    EXPECT_NEAR(clock.between(a, b), 1.0 / 960.0 + 2e-4, 1e-18);
    EXPECT_LT(a, b);
}

}  // namespace tumble::dynamic_tree_test
