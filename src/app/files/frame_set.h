// Frames of a clip that are drawn: all, the frames from a time on, or any numbers ("1-10,30-40:2"). Earlier frames are
// simulated, so that frame n does not depend on the other frames of the set.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class FrameSet {
public:
    FrameSet() = default;
    /// The frames from `first` to before `end`.
    FrameSet(std::int64_t first, std::int64_t end) { append(first, end); }

    /// Adds the frames from `first` to before `end`. Precondition: `first` is after all frames of the set.
    void append(std::int64_t first, std::int64_t end);

    bool empty() const { return runs_.empty(); }
    bool contains(std::int64_t frame) const;
    bool contiguous() const { return runs_.size() <= 1; }
    std::int64_t count() const { return count_; }
    // Precondition of first() and last(): the set is not empty.
    std::int64_t first() const { return runs_.front().first; }
    std::int64_t last() const { return runs_.back().end - 1; }
    std::int64_t end() const { return runs_.empty() ? 0 : runs_.back().end; }  // one after the last frame

    /// The smallest frame of the set above `frame`; end() if there is none.
    std::int64_t after(std::int64_t frame) const;

    void for_each(const std::function<void(std::int64_t)>& use) const;
    /// The frames for which `wanted` is true.
    FrameSet where(const std::function<bool(std::int64_t)>& wanted) const;
    FrameSet united_with(const FrameSet& other) const;

    /// "3", "1-10", "1-10,12"; above `most` pieces the rest is "...".
    std::string text(std::size_t most = 8) const;

    friend bool operator==(const FrameSet& a, const FrameSet& b) { return a.runs_ == b.runs_; }

private:
    struct Run {
        std::int64_t first, end;
        friend bool operator==(const Run&, const Run&) = default;
    };
    std::vector<Run> runs_;  // ascending, with gaps between them
    std::int64_t count_ = 0;
};

/// Numbers from 0 in the syntax of range expressions of OpenJD: "7", "1-10", "30-40:2", and several with commas between
/// them, in any order. Throws InputError, also for frames that are named twice and for frames beyond a clip of
/// `frame_count` frames.
FrameSet read_frame_set(std::string_view text, std::int64_t frame_count);

}  // namespace tumble
