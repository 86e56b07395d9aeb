// A few threads that share a loop. The assignment of items to threads is arbitrary; items write only to their own
// places, so that results do not depend on it.
//
// Each body belongs to one thread, so that its data stays in one core's cache from stage to stage and step to step:
// fetching data that another core has written costs as much as the work on it. This assignment changes no result
// either.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace tumble {

class ThreadPool {
public:
    /// `threads`: total number, including the caller's.
    /// Throws RunError if that many cannot be started.
    explicit ThreadPool(int threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int size() const { return int(workers_.size()) + 1; }

    /// Calls body(item, thread) for every item in [0, count); thread is in [0, size()). Returns when all are done and
    /// rethrows the first exception in item order.
    void for_each(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t item, std::size_t thread)>& body);

    /// Calls body(thread) once on every thread, all at the same time.
    void together(const std::function<void(std::size_t thread)>& body);

    /// The thread that a body belongs to.
    std::size_t thread_of(std::uint32_t body) const {
        return body < owner_.size() && owner_[body] != nobody ? owner_[body] : body / 64 % std::size_t(size());
    }
    void give(std::uint32_t body, std::size_t thread);
    /// Increases whenever a body is assigned to another thread.
    std::uint64_t owner_changes() const { return owner_changes_; }

    /// Calls visit(body) for each body on its thread; below `grain` bodies all on the caller's.
    template <class Visit>
    void for_bodies(std::span<const std::uint32_t> bodies, std::size_t grain, Visit&& visit) {
        if (workers_.empty() || bodies.size() < grain) {
            for (const std::uint32_t i : bodies) visit(i);
            return;
        }
        together([&](std::size_t thread) {
            for (const std::uint32_t i : bodies)
                if (thread_of(i) == thread) visit(i);
        });
    }

private:
    static constexpr std::uint8_t nobody = UINT8_MAX;
    void start();
    void wait_for_workers();
    void live(std::size_t thread);
    void work(std::size_t thread);
    void end_workers();
    void call(std::size_t item, std::size_t thread);

    std::vector<std::jthread> workers_;
    std::vector<std::uint8_t> owner_;  // by body
    std::uint64_t owner_changes_ = 0;
    std::mutex mutex_;
    std::condition_variable start_, done_;
    const std::function<void(std::size_t, std::size_t)>* body_ = nullptr;
    std::atomic<std::size_t> next_{0};
    std::size_t count_ = 0, chunk_ = 1;
    bool one_each_ = false;
    // Changed with the mutex held, read without it: phases follow each other within microseconds, faster than a
    // sleeping thread wakes up.
    std::atomic<std::size_t> running_{0}, round_{0};
    std::atomic<bool> stop_{false};
    std::exception_ptr error_;
    std::size_t error_item_ = 0;
};

}  // namespace tumble

namespace tumble::tuning {

// Numbers of items from which on several threads share the work. No result depends on them.

/// Pairs or islands from which on other threads are woken. Limits the cost.
inline constexpr std::size_t parallel_grain = 64;

/// Bodies from which on threads share the work, whose forces are applied or whose poses are advanced. Limits the cost.
inline constexpr std::size_t parallel_bodies = 512;

}  // namespace tumble::tuning
