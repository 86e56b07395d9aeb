// Joins the segments of a clip by ffmpeg's concat demuxer, without encoding them again (of a GIF: encodes them at once,
// for its colors are chosen over the whole clip). The same segments give the same bytes.
#pragma once

#include "output/process.h"
#include "output/video_format.h"

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Files of segments in their order, in one folder.
struct ClipSegments {
    std::filesystem::path folder;
    std::vector<std::string> names;
    std::vector<std::int64_t> frames;  // that each shows
    std::int64_t stored = 0;           // frames in all files together
};

class SegmentJoiner {
public:
    /// `mark`: goes into the clip, for mark_of_clip().
    SegmentJoiner(const std::filesystem::path& clip, const VideoFormat& format, const std::string& mark);

    /// A WAV file for the clip. Before join().
    void set_sound(const std::filesystem::path& file) { sound_ = file; }

    /// Writes the clip under its name. Throws RunError with ffmpeg's message, or if the clip is not whole.
    void join(const ClipSegments& segments);

    /// Stops it at once, from any thread.
    void abandon();

    double encoder_seconds() const { return encoder_seconds_; }  // CPU time of ffmpeg, s

private:
    std::filesystem::path clip_;
    VideoFormat format_;
    std::string mark_;
    std::filesystem::path sound_;
    double encoder_seconds_ = 0.0;
    std::mutex mutex_;  // guards abandon() against the start of the process
    bool abandoned_ = false;
    std::optional<Process> process_;
};

/// True if the clip has the mark, that is, if it was joined from all segments of that clip.
bool clip_has_mark(const std::filesystem::path& clip, const std::string& mark);

}  // namespace tumble
