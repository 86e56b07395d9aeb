// Finished frames come from several workers; here they wait for those before them.
#pragma once

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
    /// Of so many workers, from a frame on, which must have all that is asked for.
    explicit ReorderBuffer(std::size_t workers, std::int64_t first = 0);

    /// A frame that a worker has drawn; `unchanged`: it is the same picture as the frame it drew before.
    void add(Frame frame, std::size_t worker, bool unchanged);

    /// A frame that has AOVs of its own, and the picture of the one before it (none, where no pictures are drawn).
    void add_with_last_picture(Frame frame);

    /// A frame that is the same as the one before it. Waits while far too many are ahead. False: all is over.
    bool add_repeated(std::int64_t number);

    /// A worker will add no more.
    void leave();

    /// The first error ends everything.
    void fail(std::exception_ptr error);
    void stop();

    /// Waits for the next frame. Nothing: all workers have left, or it was stopped. Throws the first error.
    std::optional<Frame> next();

private:
    struct Waiting {
        Frame frame;
        std::optional<std::size_t> worker;   // none: the picture is repeated
        bool unchanged = false;
    };
    Frame told_apart(Waiting waiting);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::int64_t, Waiting> waiting_;
    const std::int64_t first_;
    std::int64_t next_;
    std::size_t working_;
    bool stopped_ = false;
    std::exception_ptr error_;

    // A picture's number is that of the first frame that shows it: only next() looks at these.
    std::vector<std::int64_t> picture_of_worker_;
    Frame last_;
    std::int64_t last_picture_ = -1;
};

}  // namespace tumble
