#include "compare/set_compare.h"

#include "core/start_thread.h"

#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace tumble {
namespace {

class SetComparison {
public:
    SetComparison(const PairSource& next, const Tolerances& tolerances, const PairSink& found)
        : next_(next), tolerances_(tolerances), found_(found) {}

    /// Takes and compares pairs until there are none, or a thread has failed.
    void work() {
        try {
            while (const auto task = take()) {
                const auto start = std::chrono::steady_clock::now();
                ImageResult result = compare_pair(task->pair, tolerances_.of(task->pair.name));
                result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
                put(task->index, task->pair, std::move(result));
            }
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!error_) error_ = std::current_exception();
        }
    }

    std::vector<ImageResult> results() {
        if (error_) std::rethrow_exception(error_);
        return std::move(results_);
    }

private:
    struct Task {
        std::size_t index;
        ImagePair pair;
    };

    std::optional<Task> take() {
        const std::lock_guard lock(mutex_);
        if (error_) return std::nullopt;
        std::optional<ImagePair> pair = next_();
        if (!pair) return std::nullopt;
        results_.emplace_back();
        return Task{results_.size() - 1, std::move(*pair)};
    }

    void put(std::size_t index, const ImagePair& pair, ImageResult result) {
        if (found_) found_(pair, result);
        const std::lock_guard lock(mutex_);
        results_[index] = std::move(result);
    }

    const PairSource& next_;
    const Tolerances& tolerances_;
    const PairSink& found_;
    std::mutex mutex_;
    std::vector<ImageResult> results_;
    std::exception_ptr error_;
};

}  // namespace

std::vector<ImageResult> compare_pairs(const PairSource& next, const Tolerances& tolerances, int workers,
                                       const PairSink& found) {
    SetComparison comparison(next, tolerances, found);
    {
        std::vector<std::jthread> threads;
        for (int i = 1; i < workers; ++i) threads.push_back(start_thread<std::jthread>([&] { comparison.work(); }));
        comparison.work();
    }
    return comparison.results();
}

}  // namespace tumble
