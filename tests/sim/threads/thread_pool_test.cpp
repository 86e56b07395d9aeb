// Every item once, for any sizes; exceptions arrive in item order; the pool works on afterwards.
#include "sim/threads/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace tumble::thread_pool_test {

TEST(ThreadPool, EveryItemExactlyOnce) {
    for (const int threads : {1, 2, 3, 4, 8}) {
        ThreadPool pool(threads);
        EXPECT_EQ(pool.size(), threads);
        for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 63u, 64u, 65u, 1000u, 4097u})
            for (const std::size_t grain : {0u, 1u, 64u, 5000u}) {
                std::vector<int> calls(count, 0);  // one place per item: a second call would be a data race
                std::atomic<bool> known{true};
                pool.for_each(count, grain, [&](std::size_t item, std::size_t thread) {
                    ++calls.at(item);
                    if (thread >= std::size_t(threads)) known = false;
                });
                EXPECT_EQ(calls, std::vector<int>(count, 1)) << threads << " threads, " << count << " items";
                EXPECT_TRUE(known);
            }
    }
}

// A thread's index is its own for the whole loop: data written under that index needs no lock.
TEST(ThreadPool, ThreadIndicesAreNotShared) {
    ThreadPool pool(4);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::size_t> sums(4, 0);
        pool.for_each(500, 1, [&](std::size_t item, std::size_t thread) { sums[thread] += item; });
        EXPECT_EQ(sums[0] + sums[1] + sums[2] + sums[3], 500u * 499u / 2u);
    }
}

TEST(ThreadPool, FirstExceptionInItemOrder) {
    for (const int threads : {1, 2, 4}) {
        ThreadPool pool(threads);
        for (int round = 0; round < 50; ++round) {
            const int first = 13 + round;
            try {
                pool.for_each(300, 1, [&](std::size_t item, std::size_t) {
                    if (int(item) >= first && int(item) % 2 == first % 2)
                        throw std::runtime_error(std::to_string(item));
                });
                FAIL() << "nothing thrown";
            } catch (const std::runtime_error& error) {
                EXPECT_EQ(error.what(), std::to_string(first)) << threads;
            }
            // And it works again, without remains of the exception.
            std::atomic<int> calls{0};
            EXPECT_NO_THROW(pool.for_each(300, 1, [&](std::size_t, std::size_t) { ++calls; }));
            EXPECT_EQ(calls, 300);
        }
    }
}

TEST(ThreadPool, ManyShortRounds) {
    ThreadPool pool(4);
    std::atomic<std::size_t> calls{0};
    for (int round = 0; round < 3000; ++round)
        pool.for_each(2 + std::size_t(round % 5), 1, [&](std::size_t, std::size_t) { ++calls; });
    EXPECT_EQ(calls, 3000u / 5u * (2 + 3 + 4 + 5 + 6));
}

TEST(ThreadPool, ConstructionAndDestructionWithoutWork) {
    for (int i = 0; i < 50; ++i) ThreadPool pool(1 + i % 6);
}

// Bodies belong to one thread each, from loop to loop; all of them are visited once.
TEST(ThreadPool, BodiesStayWithTheirThreads) {
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t i = 0; i < 700; ++i) bodies.push_back(3 * i);
    for (const int threads : {1, 2, 3}) {
        ThreadPool pool(threads);
        for (const std::uint32_t i : bodies)
            if (i % 2 == 0) pool.give(i, i % std::size_t(threads));
        std::vector<std::thread::id> of_thread(3);
        pool.together([&](std::size_t thread) { of_thread[thread] = std::this_thread::get_id(); });
        for (const std::size_t grain : {std::size_t(1), bodies.size() + 1}) {
            std::vector<int> visits(2100, 0);
            std::atomic<bool> kept{true};
            pool.for_bodies(bodies, grain, [&](std::uint32_t i) {
                ++visits[i];
                const bool alone = grain > bodies.size();
                if (std::this_thread::get_id() != of_thread[alone ? 0 : pool.thread_of(i)]) kept = false;
                if (i % 2 == 0 && pool.thread_of(i) != i % std::size_t(threads)) kept = false;
            });
            for (std::uint32_t i = 0; i < 2100; ++i) ASSERT_EQ(visits[i], i % 3 == 0) << i;
            EXPECT_TRUE(kept) << threads << " threads";
        }
    }
}

}  // namespace tumble::thread_pool_test
