#include "sim/thread_pool.h"

#include <algorithm>

namespace tumble {

ThreadPool::ThreadPool(int threads) {
    for (int i = 1; i < threads; ++i)
        workers_.emplace_back([this, i] {
            std::size_t seen = 0;
            while (true) {
                {
                    std::unique_lock lock(mutex_);
                    start_.wait(lock, [&] { return stop_ || round_ != seen; });
                    if (stop_) return;
                    seen = round_;
                }
                work(std::size_t(i));
                const std::lock_guard lock(mutex_);
                if (--running_ == 0) done_.notify_one();
            }
        });
}

ThreadPool::~ThreadPool() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    start_.notify_all();
}

void ThreadPool::work(std::size_t thread) {
    while (true) {
        const std::size_t first = next_.fetch_add(chunk_);
        if (first >= count_) return;
        for (std::size_t item = first; item < std::min(first + chunk_, count_); ++item) {
            try {
                (*body_)(item, thread);
            } catch (...) {
                const std::lock_guard lock(mutex_);
                if (!error_ || item < error_item_) {
                    error_ = std::current_exception();
                    error_item_ = item;
                }
            }
        }
    }
}

void ThreadPool::for_each(std::size_t count, std::size_t grain,
                          const std::function<void(std::size_t, std::size_t)>& body) {
    if (workers_.empty() || count < 2 || count < grain) {
        for (std::size_t i = 0; i < count; ++i) body(i, 0);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        body_ = &body;
        count_ = count;
        chunk_ = std::max<std::size_t>(1, count / (8 * std::size_t(size())));
        next_ = 0;
        running_ = workers_.size();
        error_ = nullptr;
        ++round_;
    }
    start_.notify_all();
    work(0);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return running_ == 0; });
    if (error_) std::rethrow_exception(error_);
}

}  // namespace tumble
