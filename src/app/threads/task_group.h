// A group of threads: if one of them fails, or after an interrupt, all of them stop, and the first error is reported.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tumble {

class TaskGroup {
public:
    TaskGroup() = default;
    /// Stops the running stages and waits for them.
    ~TaskGroup();
    TaskGroup(const TaskGroup&) = delete;
    TaskGroup& operator=(const TaskGroup&) = delete;

    /// Action that makes the stages end, such as canceling a queue or stopping a program; called once. Register it
    /// before start().
    void on_stop(std::function<void()> action);

    /// Runs a stage in a thread of its own. An exception that leaves the stage stops the group.
    void start(std::function<void()> stage);

    /// Makes all stages end soon. Only the first reason is kept.
    void stop(std::exception_ptr why);

    /// Waits at most this long; true if every stage has ended.
    bool wait(std::chrono::milliseconds at_most);

    /// Waits for every stage, then throws the first error, if any.
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

// Default number of simulation threads beside the render processes. The result is the same for any number.

/// Upper limit of numbers of threads or processes; more are considered a mistake.
inline constexpr int most_threads = 256;

/// Number of processor cores.
int machine_threads();

/// At least 1, at most `cores`.
int simulation_threads_beside_drawing(std::size_t bodies, int cores);

}  // namespace tumble
