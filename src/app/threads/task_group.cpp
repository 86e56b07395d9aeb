#include "app/threads/task_group.h"

#include "core/error.h"
#include "core/start_thread.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace tumble {

TaskGroup::~TaskGroup() {
    if (!wait(std::chrono::milliseconds(0))) stop(std::make_exception_ptr(RunError("stopped")));
    join();
}

void TaskGroup::on_stop(std::function<void()> action) { stop_actions_.push_back(std::move(action)); }

void TaskGroup::start(std::function<void()> stage) {
    {
        const std::lock_guard lock(mutex_);
        ++running_;
    }
    const auto run = [this, work = std::move(stage)] {
        try {
            work();
        } catch (...) {
            stop(std::current_exception());
        }
        const std::lock_guard lock(mutex_);
        --running_;
        ended_.notify_all();
    };
    try {
        threads_.push_back(start_thread<std::thread>(run));
    } catch (...) {  // the system has no more threads
        const std::lock_guard lock(mutex_);
        --running_;
        throw;
    }
}

void TaskGroup::stop(std::exception_ptr why) {
    {
        const std::lock_guard lock(mutex_);
        if (error_) return;
        error_ = std::move(why);
    }
    for (const auto& action : stop_actions_) action();
}

bool TaskGroup::wait(std::chrono::milliseconds at_most) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, at_most, [&] { return running_ == 0; });
}

void TaskGroup::finish() {
    join();
    if (error_) std::rethrow_exception(error_);
}

void TaskGroup::join() {
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

namespace {

// Threads that share a step wait for each other by spinning, on cores that drawing needs: a hundred boxes on two cores
// took 0.24 s of processor time for 151 frames with one thread, 0.42 s with two; a clip of a thousand took a tenth less
// with one.
constexpr std::size_t bodies_a_thread = 500;
constexpr std::size_t many_bodies = 5000;  // above this number a step takes so long that drawing would wait for it

}  // namespace

int machine_threads() { return std::clamp(int(std::thread::hardware_concurrency()), 1, most_threads); }

int simulation_threads_beside_drawing(std::size_t bodies, int cores) {
    const int most = bodies < many_bodies ? std::max(cores / 2, 1) : cores;
    return int(std::clamp<std::size_t>(bodies / bodies_a_thread, 1, std::size_t(most)));
}

}  // namespace tumble
