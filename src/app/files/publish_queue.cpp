#include "app/files/publish_queue.h"

#include <utility>

namespace tumble {

bool PublishQueue::put(std::unique_ptr<TemporaryFile> file) {
    file->begin_sync();
    return files_.push({put_++, std::move(file)});
}

void PublishQueue::run(StageTime& time) {
    while (std::optional<Waiting> waiting = files_.pop()) {
        {
            const StageTimer timer(time);
            waiting->file->sync();
        }
        if (!wait_for_turn(waiting->number)) return;
        const StageTimer timer(time);
        waiting->file->publish();
        const std::lock_guard lock(mutex_);
        ++published_;
        turn_.notify_all();
    }
}

bool PublishQueue::wait_for_turn(std::int64_t number) {
    std::unique_lock lock(mutex_);
    turn_.wait(lock, [&] { return cancelled_ || published_ == number; });
    return !cancelled_;
}

void PublishQueue::cancel() {
    files_.cancel();
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
    turn_.notify_all();
}

}  // namespace tumble
