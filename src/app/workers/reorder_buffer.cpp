#include "app/workers/reorder_buffer.h"

#include "core/check.h"

#include <utility>

namespace tumble {
namespace {

constexpr std::int64_t most_ahead = 4096;  // bounds the repeated frames that wait for a drawn one, which are small

}  // namespace

ReorderBuffer::ReorderBuffer(std::size_t workers, FrameSet frames)
    : frames_(std::move(frames)), next_(frames_.first()), working_(workers), image_of_worker_(workers, -1) {}

void ReorderBuffer::add(Frame frame, std::size_t worker, bool unchanged) {
    const std::lock_guard lock(mutex_);
    const std::int64_t number = frame.number;
    waiting_.emplace(number, Waiting{std::move(frame), worker, unchanged});
    changed_.notify_all();
}

void ReorderBuffer::add_with_last_image(Frame frame) {
    const std::lock_guard lock(mutex_);
    const std::int64_t number = frame.number;
    waiting_.emplace(number, Waiting{std::move(frame), std::nullopt, true});
    changed_.notify_all();
}

bool ReorderBuffer::add_repeated(std::int64_t number) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || number < next_ + most_ahead; });
    if (stopped_) return false;
    Frame frame;
    frame.number = number;
    waiting_.emplace(number, Waiting{std::move(frame), std::nullopt, true});
    if (number == next_) changed_.notify_all();
    return true;
}

void ReorderBuffer::leave() {
    const std::lock_guard lock(mutex_);
    --working_;
    changed_.notify_all();
}

void ReorderBuffer::fail(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!stopped_) error_ = std::move(error);
    stopped_ = true;
    changed_.notify_all();
}

void ReorderBuffer::stop() { fail(nullptr); }

std::optional<Frame> ReorderBuffer::next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || waiting_.contains(next_) || working_ == 0; });
    if (error_) std::rethrow_exception(error_);
    const auto found = waiting_.find(next_);
    if (stopped_ || found == waiting_.end()) return std::nullopt;
    Waiting waiting = std::move(found->second);
    waiting_.erase(found);
    next_ = frames_.after(next_);
    changed_.notify_all();
    return marked_repeated(std::move(waiting));
}

/// Frames arrive here in order, so the previous frame of the worker is known.
Frame ReorderBuffer::marked_repeated(Waiting waiting) {
    Frame& frame = waiting.frame;
    const bool follows = frames_.contains(frame.number - 1);
    TUMBLE_CHECK_EQ(follows || waiting.worker || frame.aov_slot, true);
    if (!frame.aov_slot) {
        frame.aovs = last_.aovs;
        frame.aov_slot = last_.aov_slot;
    }
    if (!waiting.worker) {
        frame.repeated = follows;
        frame.video = last_.video;
        frame.png = last_.png;
        frame.slot = last_.slot;
        last_ = std::move(frame);
        return last_;
    }
    std::int64_t& worker = image_of_worker_[*waiting.worker];
    const std::int64_t image = waiting.unchanged ? worker : frame.number;
    frame.repeated = image == last_image_;
    worker = last_image_ = image;
    last_ = std::move(frame);
    return last_;
}

}  // namespace tumble
