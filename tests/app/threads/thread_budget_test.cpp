#include "app/threads/task_group.h"

#include <gtest/gtest.h>

namespace tumble::thread_budget_test {
namespace {

TEST(ThreadBudget, LeaveTheCoresToDrawing) {
    EXPECT_EQ(simulation_threads_beside_drawing(0, 8), 1);
    EXPECT_EQ(simulation_threads_beside_drawing(100, 8), 1);
    EXPECT_EQ(simulation_threads_beside_drawing(1000, 2), 1);
    EXPECT_EQ(simulation_threads_beside_drawing(1000, 8), 2);
    EXPECT_EQ(simulation_threads_beside_drawing(4999, 8), 4);
    EXPECT_EQ(simulation_threads_beside_drawing(100'000, 1), 1);
    EXPECT_EQ(simulation_threads_beside_drawing(100'000, 8), 8);
}

TEST(ThreadBudget, MoreBodiesNeverGetFewer) {
    for (const int cores : {1, 2, 3, 16, 256})
        for (std::size_t bodies = 1; bodies < 200'000; bodies += 97)
            EXPECT_LE(simulation_threads_beside_drawing(bodies - 1, cores),
                      simulation_threads_beside_drawing(bodies, cores));
}

}  // namespace
}  // namespace tumble::thread_budget_test
