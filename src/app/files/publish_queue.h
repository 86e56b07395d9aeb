// Files that are written wait here until they are on the disk, and get their names in the order in which they were put.
#pragma once

#include "app/threads/bounded_queue.h"
#include "app/threads/stage_timer.h"
#include "output/temporary_file.h"

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>

namespace tumble {

/// Where one file at a time is waited for, a journaling file system commits each by itself, which takes longer than drawing
/// a frame; those that are waited for together share a commit (measured in docs/explanation/output.md).
class PublishQueue {
public:
    static constexpr int threads = 4;   // that wait at once: with them PNG frames come as fast as without waiting

    PublishQueue() : files_(waiting_files) {}

    /// Hands on a file that is written. False: the queue was canceled, and the file is dropped. By one thread.
    bool put(std::unique_ptr<TemporaryFile> file);

    /// The work of each of the threads, until the queue is closed and empty, or canceled. Throws RunError.
    void run(StageTime& time);

    void close() { files_.close(); }
    void cancel();

    /// How many files have their names.
    std::int64_t published() const { return published_; }

private:
    static constexpr std::size_t waiting_files = 8;   // each is an open file

    struct Waiting {
        std::int64_t number;
        std::unique_ptr<TemporaryFile> file;
    };
    bool wait_for_turn(std::int64_t number);

    BoundedQueue<Waiting> files_;
    std::int64_t put_ = 0;
    std::mutex mutex_;   // of published_ where it is waited for
    std::condition_variable turn_;
    std::atomic<std::int64_t> published_{0};
    bool cancelled_ = false;
};

}  // namespace tumble
