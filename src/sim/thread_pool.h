// A few threads that share out a loop. Which thread does which item is left to chance; items write only to places of
// their own, so that the result is not.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tumble {

class ThreadPool {
public:
    /// `threads` in all, the caller's included.
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

private:
    void start();
    void wait_for_workers();
    void work(std::size_t thread);
    void call(std::size_t item, std::size_t thread);

    std::vector<std::jthread> workers_;
    std::mutex mutex_;
    std::condition_variable start_, done_;
    const std::function<void(std::size_t, std::size_t)>* body_ = nullptr;
    std::atomic<std::size_t> next_{0};
    std::size_t count_ = 0, chunk_ = 1;
    bool one_each_ = false;
    // Changed with the mutex held, looked at without it: phases follow each other within microseconds, faster than a
    // sleeping thread wakes up.
    std::atomic<std::size_t> running_{0}, round_{0};
    std::atomic<bool> stop_{false};
    std::exception_ptr error_;
    std::size_t error_item_ = 0;
};

}  // namespace tumble
