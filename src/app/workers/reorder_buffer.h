// Reorder buffer: finished frames of several workers wait here for earlier frames.
#pragma once

#include "app/files/frame_set.h"
#include "app/workers/render_pool.h"

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace tumble {

class ReorderBuffer {
public:
    /// `workers`: their number; `frames`: those to come. Each frame that does not follow the one before it in the set
    /// by one must have all outputs.
    ReorderBuffer(std::size_t workers, FrameSet frames);

    /// Adds a drawn frame; `unchanged`: it is the same image as the previous frame of this worker.
    void add(Frame frame, std::size_t worker, bool unchanged);

    /// Adds a frame with its own AOVs and the image of the previous frame (empty if no images are drawn).
    void add_with_last_image(Frame frame);

    /// Adds a frame that equals the previous one. Waits while too many are ahead. False: the buffer was stopped.
    bool add_repeated(std::int64_t number);

    /// A worker will add no more.
    void leave();

    /// Stores the first error and stops the buffer.
    void fail(std::exception_ptr error);
    void stop();

    /// Waits for the next frame. Empty: all workers have left, or it was stopped. Throws the first error.
    std::optional<Frame> next();

private:
    struct Waiting {
        Frame frame;
        std::optional<std::size_t> worker;  // none: the image is repeated
        bool unchanged = false;
    };
    Frame marked_repeated(Waiting waiting);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::int64_t, Waiting> waiting_;
    const FrameSet frames_;
    std::int64_t next_;
    std::size_t working_;
    bool stopped_ = false;
    std::exception_ptr error_;

    // An image's number is that of the first frame that shows it; only next() uses these.
    std::vector<std::int64_t> image_of_worker_;
    Frame last_;
    std::int64_t last_image_ = -1;
};

}  // namespace tumble
