// Threads that work as one: when one of them fails, or the user interrupts, all of them stop, and the first error is
// the one that is reported.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tumble {

class TaskGroup {
public:
    TaskGroup() = default;
    /// Stops what still runs and waits for it.
    ~TaskGroup();
    TaskGroup(const TaskGroup&) = delete;
    TaskGroup& operator=(const TaskGroup&) = delete;

    /// What to do, once, to make the stages come to an end: cancel a queue, stop a program. Say so before start().
    void on_stop(std::function<void()> action);

    /// Runs a stage in a thread of its own. An exception that leaves it stops the group.
    void start(std::function<void()> stage);

    /// Makes all stages end soon. Only the first reason is kept.
    void stop(std::exception_ptr why);

    /// Waits at most so long; true when every stage has ended.
    bool wait(std::chrono::milliseconds at_most);

    /// Waits for every stage, then throws the first error, if there was one.
    void finish();

private:
    void join();

    std::mutex mutex_;
    std::condition_variable ended_;
    std::vector<std::function<void()>> stop_actions_;
    std::vector<std::thread> threads_;
    std::size_t running_ = 0;
    std::exception_ptr error_;
};

}  // namespace tumble
