// Sets of frames, and the syntax of --frames-range.
#include "app/files/frame_set.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace tumble::frame_set_test {
namespace {

std::vector<std::int64_t> numbers_of(const FrameSet& set) {
    std::vector<std::int64_t> numbers;
    set.for_each([&](std::int64_t n) { numbers.push_back(n); });
    return numbers;
}

TEST(FrameSet, RangeExpressions) {
    using Numbers = std::vector<std::int64_t>;
    EXPECT_EQ(numbers_of(read_frame_set("7", 100)), (Numbers{7}));
    EXPECT_EQ(numbers_of(read_frame_set("1-3, 8", 100)), (Numbers{1, 2, 3, 8}));
    EXPECT_EQ(numbers_of(read_frame_set("30-36:3,0-1", 100)), (Numbers{0, 1, 30, 33, 36}));
    EXPECT_EQ(numbers_of(read_frame_set("30-35:3", 34)), (Numbers{30, 33}));  // no frame 35
    EXPECT_EQ(numbers_of(read_frame_set("0-0", 1)), (Numbers{0}));
    EXPECT_EQ(read_frame_set("0-4,5-9", 10), FrameSet(0, 10));
    for (const char* const text : {"",    ",",   "1,",      "a",      "-1",      "1-",  "1--2",
                                   "3-1", "1:2", "1-4:0",   "1-4:-1", "1-4:",    "1 2", "0x1",
                                   "1.0", "+1",  "1-3,3-4", "5,5",    "0-8:4,4", "100", "99999999999999999999"})
        EXPECT_THROW(read_frame_set(text, 100), InputError) << text;
}

TEST(FrameSet, SetOperations) {
    std::mt19937 random(5);
    for (int repetition = 0; repetition < 100; ++repetition) {
        FrameSet sets[2];
        std::set<std::int64_t> all, each[2];
        for (int i = 0; i < 2; ++i)
            for (std::int64_t n = 0; n < 40; ++n)
                if (random() % 3 == 0) {
                    sets[i].append(n, n + 1);
                    each[i].insert(n);
                    all.insert(n);
                }
        const FrameSet both = sets[0].united_with(sets[1]);
        EXPECT_EQ(numbers_of(both), std::vector<std::int64_t>(all.begin(), all.end()));
        EXPECT_EQ(both.count(), std::int64_t(all.size()));
        for (std::int64_t n = -1; n < 42; ++n) {
            EXPECT_EQ(both.contains(n), all.contains(n));
            const auto next = all.upper_bound(n);
            EXPECT_EQ(both.after(n), next == all.end() ? both.end() : *next) << n;
        }
        const FrameSet common = sets[0].where([&](std::int64_t n) { return sets[1].contains(n); });
        for (std::int64_t n = 0; n < 40; ++n) EXPECT_EQ(common.contains(n), each[0].contains(n) && each[1].contains(n));
    }
}

TEST(FrameSet, Text) {
    EXPECT_EQ(FrameSet().text(), "");
    EXPECT_EQ(read_frame_set("1-3,5,7-8", 10).text(), "1-3,5,7-8");
    EXPECT_EQ(read_frame_set("0-8:2", 10).text(3), "0,2,4,...");
    EXPECT_TRUE(FrameSet(3, 9).contiguous());
    EXPECT_FALSE(read_frame_set("1,3", 10).contiguous());
    EXPECT_TRUE(FrameSet(3, 3).empty());
}

}  // namespace
}  // namespace tumble::frame_set_test
