#include "sim/threads/thread_pool.h"

#include "core/start_thread.h"

#include <algorithm>

namespace tumble {
namespace {

// Polls of a waiting thread before it sleeps: about 3 microseconds of spinning, then about 300 of yielding, in which
// other threads get the core, such as a worker on the same core. Waking a sleeper takes as long as many a stage of a
// step.
constexpr int patience = 100, yielding_patience = 600;

template <class Ready>
bool spin_until(Ready&& ready) {
    for (int tries = 0; tries < patience + yielding_patience; ++tries) {
        if (ready()) return true;
        if (tries < patience)
            __builtin_ia32_pause();
        else
            std::this_thread::yield();
    }
    return false;
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
    try {
        for (int i = 1; i < threads; ++i)
            workers_.push_back(start_thread<std::jthread>([this, i] { live(std::size_t(i)); }));
    } catch (...) {
        end_workers();  // workers that have started wait for work
        throw;
    }
}

/// Main loop of a worker.
void ThreadPool::live(std::size_t thread) {
    std::size_t seen = 0;
    while (true) {
        const auto called = [&] { return stop_ || round_ != seen; };
        if (!spin_until(called)) {
            std::unique_lock lock(mutex_);
            start_.wait(lock, called);
        }
        if (stop_) return;
        seen = round_;
        work(thread);
        if (running_.fetch_sub(1) == 1) {
            const std::lock_guard lock(mutex_);  // the caller is either before its poll or asleep
            done_.notify_one();
        }
    }
}

ThreadPool::~ThreadPool() { end_workers(); }

void ThreadPool::end_workers() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    start_.notify_all();
    workers_.clear();  // joins them while the data that they use still exists
}

void ThreadPool::give(std::uint32_t body, std::size_t thread) {
    if (body >= owner_.size()) owner_.resize(body + 1, nobody);
    const auto owner = std::uint8_t(std::min<std::size_t>(thread, nobody));
    if (owner_[body] == owner) return;
    owner_[body] = owner;
    ++owner_changes_;
}

void ThreadPool::call(std::size_t item, std::size_t thread) {
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

void ThreadPool::work(std::size_t thread) {
    if (one_each_) return call(thread, thread);
    while (true) {
        const std::size_t first = next_.fetch_add(chunk_);
        if (first >= count_) return;
        for (std::size_t item = first; item < std::min(first + chunk_, count_); ++item) call(item, thread);
    }
}

void ThreadPool::start() {
    next_ = 0;
    running_ = workers_.size();
    error_ = nullptr;
    {
        const std::lock_guard lock(mutex_);
        ++round_;
    }
    start_.notify_all();
}

void ThreadPool::wait_for_workers() {
    const auto done = [&] { return running_ == 0; };
    if (!spin_until(done)) {
        std::unique_lock lock(mutex_);
        done_.wait(lock, done);
    }
    if (error_) std::rethrow_exception(error_);
}

void ThreadPool::for_each(std::size_t count, std::size_t grain,
                          const std::function<void(std::size_t, std::size_t)>& body) {
    if (workers_.empty() || count < 2 || count < grain) {
        for (std::size_t i = 0; i < count; ++i) body(i, 0);
        return;
    }
    body_ = &body;
    one_each_ = false;
    count_ = count;
    chunk_ = std::max<std::size_t>(1, count / (8 * std::size_t(size())));
    start();
    work(0);
    wait_for_workers();
}

void ThreadPool::together(const std::function<void(std::size_t)>& body) {
    const std::function<void(std::size_t, std::size_t)> each = [&](std::size_t, std::size_t thread) { body(thread); };
    body_ = &each;
    one_each_ = true;
    start();
    work(0);
    wait_for_workers();
}

}  // namespace tumble
