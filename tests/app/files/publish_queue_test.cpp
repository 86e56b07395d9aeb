// Files get their names in the order of the queue, even if some take longer to reach the disk.
#include "app/files/publish_queue.h"
#include "core/error.h"

#include "support/folder.h"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <span>
#include <thread>
#include <vector>

namespace {

std::atomic<int> syncs{0}, at_once{0}, most_at_once{0};
std::atomic<int> failing_sync{-1};  // by number

}  // namespace

// Every third takes longer than those after it.
extern "C" int fsync(int) {
    const int number = syncs++, now = ++at_once;
    if (now > most_at_once) most_at_once = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(number % 3 == 0 ? 20 : 5));
    --at_once;
    if (number != failing_sync) return 0;
    errno = EIO;
    return -1;
}

namespace tumble::publish_queue_test {
namespace {

std::filesystem::path name_of(const TestFolder& folder, int number) { return folder / fmt::format("{:03}", number); }

/// Puts this many files; returns the threads' first error, if any. `look` is called repeatedly.
template <class Look>
bool publish(const TestFolder& folder, PublishQueue& queue, int files, const Look& look) {
    StageTime time;
    std::atomic<int> running{0};
    std::atomic<bool> failed{false};
    std::vector<std::thread> threads;
    for (int i = 0; i < PublishQueue::threads; ++i, ++running)
        threads.emplace_back([&] {
            try {
                queue.run(time);
            } catch (const RunError&) {
                failed = true;
                queue.cancel();
            }
            --running;
        });
    for (int n = 0; n < files; ++n) {
        auto file = std::make_unique<TemporaryFile>(name_of(folder, n), LeftParts::kept);
        if (!queue.put(std::move(file))) break;
    }
    queue.close();
    while (running > 0) look();
    for (std::thread& thread : threads) thread.join();
    return !failed;
}

/// Number of files; all of them without a gap, or -1.
int in_order(const TestFolder& folder, int files) {
    int there = 0;
    for (int n = files; n-- > 0;) {  // from the end, so that a file made meanwhile is no gap
        const bool exists = std::filesystem::exists(name_of(folder, n));
        if (exists) ++there;
        if (!exists && there > 0) return -1;
    }
    return there;
}

TEST(PublishQueue, NamesComeInOrder) {
    const TestFolder folder;
    PublishQueue queue;
    most_at_once = 0;
    EXPECT_TRUE(publish(folder, queue, 60, [&] { EXPECT_NE(in_order(folder, 60), -1); }));
    EXPECT_EQ(in_order(folder, 60), 60);
    EXPECT_EQ(queue.published(), 60);
    EXPECT_EQ(folder.files(), 60u);
    EXPECT_GT(most_at_once, 1) << "they do not wait for each other";
}

TEST(PublishQueue, NoneAfterOneThatFailed) {
    const TestFolder folder;
    PublishQueue queue;
    failing_sync = syncs + 30;
    EXPECT_FALSE(publish(folder, queue, 60, [] {}));
    failing_sync = -1;
    const int there = in_order(folder, 60);
    EXPECT_GE(there, 20);
    EXPECT_LE(there, 33);  // those that were waited for at the same time may be published
    EXPECT_EQ(std::size_t(there), folder.files()) << "nothing hidden is left";
}

TEST(PublishQueue, ACanceledOneLeavesNothing) {
    const TestFolder folder;
    PublishQueue queue;
    queue.cancel();
    EXPECT_TRUE(publish(folder, queue, 5, [] {}));
    EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace tumble::publish_queue_test
