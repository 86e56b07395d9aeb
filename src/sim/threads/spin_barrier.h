// A barrier for a few threads that reach it within microseconds of each other: they spin, and yield the core only when
// a thread is late.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

namespace tumble {

class SpinBarrier {
public:
    explicit SpinBarrier(std::size_t threads) : threads_(threads) {}

    void wait() {
        const std::size_t round = round_.load(std::memory_order_acquire);
        if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
            arrived_.store(0, std::memory_order_relaxed);
            round_.store(round + 1, std::memory_order_release);
            return;
        }
        for (int tries = 0; round_.load(std::memory_order_acquire) == round; ++tries) {
            if (tries < patience)
                __builtin_ia32_pause();
            else
                std::this_thread::yield();
        }
    }

private:
    static constexpr int patience =
        100;  // spins, some microseconds in all; after that the core may be needed for the others
    const std::size_t threads_;
    alignas(64) std::atomic<std::size_t> arrived_{0};
    alignas(64) std::atomic<std::size_t> round_{0};
};

}  // namespace tumble
