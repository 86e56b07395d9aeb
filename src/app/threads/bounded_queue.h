// The link between two stages: an ordered queue with a maximum length.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace tumble {

/// For any number of threads at both ends. push() waits while the queue is full, which bounds memory.
template <typename T>
class BoundedQueue {
public:
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

    /// Waits for space. False: the queue was canceled, and the value is dropped.
    bool push(T value) {
        std::unique_lock lock(mutex_);
        has_room_.wait(lock, [&] { return cancelled_ || values_.size() < capacity_; });
        if (cancelled_) return false;
        values_.push_back(std::move(value));
        lock.unlock();
        has_value_.notify_one();
        return true;
    }

    /// Waits for a value. Empty: the queue was closed and is empty, or was canceled.
    std::optional<T> pop() {
        std::unique_lock lock(mutex_);
        has_value_.wait(lock, [&] { return cancelled_ || closed_ || !values_.empty(); });
        if (cancelled_ || values_.empty()) return std::nullopt;
        std::optional<T> value(std::move(values_.front()));
        values_.pop_front();
        lock.unlock();
        has_room_.notify_one();
        return value;
    }

    /// No more values will come; values in the queue are still delivered.
    void close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        has_value_.notify_all();
    }

    /// Wakes all waiting threads and drops the values in the queue.
    void cancel() {
        const std::lock_guard lock(mutex_);
        cancelled_ = true;
        values_.clear();
        has_value_.notify_all();
        has_room_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable has_room_, has_value_;
    std::deque<T> values_;
    const std::size_t capacity_;
    bool closed_ = false, cancelled_ = false;
};

}  // namespace tumble
