// Queue of written files that wait until they are on the disk; they get their final names in the order of the queue.
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

/// With one file at a time, a journaling file system commits each separately, which takes longer than drawing a frame.
/// Files that are waited for together share a commit (measured in docs/explanation/output.md).
class PublishQueue {
public:
    static constexpr int threads = 4;  // concurrent waits: with this number, PNG frames come as fast as without waiting

    PublishQueue() : files_(waiting_files) {}

    /// Takes a written file. False: the queue was canceled, and the file is dropped. Call it from one thread only.
    bool put(std::unique_ptr<TemporaryFile> file);

    /// The work of each thread, until the queue is closed and empty, or canceled. Throws RunError.
    void run(StageTime& time);

    void close() { files_.close(); }
    void cancel();

    /// Number of files with their final names.
    std::int64_t published() const { return published_; }

private:
    static constexpr std::size_t waiting_files = 8;  // each is an open file

    struct Waiting {
        std::int64_t number;
        std::unique_ptr<TemporaryFile> file;
    };
    bool wait_for_turn(std::int64_t number);

    BoundedQueue<Waiting> files_;
    std::int64_t put_ = 0;
    std::mutex mutex_;  // guards waits for published_
    std::condition_variable turn_;
    std::atomic<std::int64_t> published_{0};
    bool cancelled_ = false;
};

}  // namespace tumble
