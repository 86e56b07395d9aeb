// Frames of several workers are put in order, and repetitions are detected.
#include "app/workers/reorder_buffer.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <thread>

namespace tumble::reorder_buffer_test {
namespace {

Frame numbered(std::int64_t number) {
    Frame frame;
    frame.number = number;
    frame.slot = std::make_shared<std::int64_t>(number);
    return frame;
}

std::int64_t slot_of(const Frame& frame) { return *static_cast<const std::int64_t*>(frame.slot.get()); }

TEST(ReorderBuffer, PutsFramesInOrder) {
    ReorderBuffer order(2, {0, 100'000});
    for (const std::int64_t n : {3, 1, 0, 2}) order.add(numbered(n), std::size_t(n % 2), false);
    for (std::int64_t n = 0; n < 4; ++n) {
        const std::optional<Frame> frame = order.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->number, n);
        EXPECT_EQ(slot_of(*frame), n);
        EXPECT_FALSE(frame->repeated);
    }
    order.leave();
    order.leave();
    EXPECT_FALSE(order.next());
}

TEST(ReorderBuffer, ARepeatedFrameShowsTheOneBefore) {
    ReorderBuffer order(1, {0, 100'000});
    ASSERT_TRUE(order.add_repeated(1));
    ASSERT_TRUE(order.add_repeated(2));
    order.add(numbered(3), 0, false);
    order.add(numbered(0), 0, false);
    const std::int64_t slots[] = {0, 0, 0, 3};
    for (std::int64_t n = 0; n < 4; ++n) {
        const std::optional<Frame> frame = order.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->number, n);
        EXPECT_EQ(slot_of(*frame), slots[n]);
        EXPECT_EQ(frame->repeated, n == 1 || n == 2);
    }
}

TEST(ReorderBuffer, AovsAreIndependentOfPictures) {
    ReorderBuffer order(1, {0, 100'000});
    const auto with_aovs = [](Frame frame) {
        frame.aov_slot = std::make_shared<std::int64_t>(frame.number);
        return frame;
    };
    const auto aovs_of = [](const Frame& frame) { return *static_cast<const std::int64_t*>(frame.aov_slot.get()); };
    order.add(with_aovs(numbered(0)), 0, false);
    Frame no_picture;
    no_picture.number = 1;
    order.add_with_last_image(with_aovs(no_picture));
    order.add(numbered(2), 0, false);
    ASSERT_TRUE(order.add_repeated(3));
    const std::int64_t pictures[] = {0, 0, 2, 2}, aovs[] = {0, 1, 1, 1};
    for (std::int64_t n = 0; n < 4; ++n) {
        const std::optional<Frame> frame = order.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->number, n);
        EXPECT_EQ(slot_of(*frame), pictures[n]);
        EXPECT_EQ(aovs_of(*frame), aovs[n]);
        EXPECT_EQ(frame->repeated, n % 2 == 1);
    }
}

TEST(ReorderBuffer, UnchangedRefersToTheWorkersOwnFrame) {
    // Worker 0 draws 0, 2, 4, 5; worker 1 draws 1, 3. A frame that is "unchanged" since the worker's own previous frame
    // is a repetition only if that is also the previous image of the clip.
    ReorderBuffer order(2, {0, 100'000});
    const auto add = [&](std::int64_t n, std::size_t worker, bool unchanged) {
        order.add(numbered(n), worker, unchanged);
    };
    add(0, 0, false);
    add(1, 1, false);
    add(2, 0, true);  // the image of 0 again, after that of 1
    add(3, 1, true);  // the image of 1 again, after that of 0
    add(4, 0, false);
    add(5, 0, true);
    const bool repeated[] = {false, false, false, false, false, true};
    for (const bool expected : repeated) EXPECT_EQ(order.next()->repeated, expected);
}

TEST(ReorderBuffer, TheFirstErrorIsThrown) {
    ReorderBuffer order(2, {0, 100'000});
    order.add(numbered(1), 0, false);
    std::thread later([&] {
        order.fail(std::make_exception_ptr(RunError("first")));
        order.fail(std::make_exception_ptr(RunError("second")));
    });
    try {
        order.next();
        ADD_FAILURE() << "no error";
    } catch (const RunError& error) {
        EXPECT_STREQ(error.what(), "error: first");
    }
    later.join();
    EXPECT_FALSE(order.add_repeated(5));
}

TEST(ReorderBuffer, RepeatedFramesWaitForThoseBefore) {
    ReorderBuffer order(2, {0, 100'000});
    std::thread ahead([&] {
        std::int64_t n = 1;
        while (order.add_repeated(n)) ++n;
        EXPECT_LT(n, 100'000);
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    order.stop();
    ahead.join();
}

}  // namespace
}  // namespace tumble::reorder_buffer_test
