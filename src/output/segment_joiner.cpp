#include "output/segment_joiner.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/clip_check.h"
#include "output/temporary_file.h"
#include "output/video_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>

namespace tumble {
namespace {

namespace fs = std::filesystem;

std::string comment_of(const std::string& mark) { return fmt::format("Tumble-Scene {}", mark); }

/// The list for the concat demuxer. Durations are differences of rounded times, so that their errors do not add up.
std::string list_of(const ClipSegments& segments, const VideoFormat& format) {
    std::string list = "ffconcat version 1.0\n";
    std::int64_t frames = 0, before = 0;  // us
    for (std::size_t i = 0; i < segments.names.size(); ++i) {
        frames += segments.frames[i];
        const auto end = std::int64_t(
            std::llround(1e6 * double(frames) * double(format.rate.denominator) / double(format.rate.numerator)));
        list += fmt::format("file '{}'\nduration {}.{:06}\n", segments.names[i], (end - before) / 1'000'000,
                            (end - before) % 1'000'000);
        before = end;
    }
    return list;
}

/// Puts a comment before the trailer of a GIF; ffmpeg writes none.
bool add_gif_comment(const fs::path& gif, const std::string& comment) {
    std::fstream file(gif, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(-1, std::ios::end);
    constexpr char trailer = 0x3b;
    if (file.get() != trailer) return false;
    std::string end{0x21, char(0xfe), char(comment.size())};
    end += comment;
    end += '\0';
    end += trailer;
    file.seekp(-1, std::ios::end);
    file.write(end.data(), std::streamsize(end.size()));
    return file.flush().good();
}

}  // namespace

SegmentJoiner::SegmentJoiner(const fs::path& clip, const VideoFormat& format, const std::string& mark)
    : clip_(clip), format_(format), mark_(mark) {}

void SegmentJoiner::join(const ClipSegments& segments) {
    const bool gif = format_.kind == VideoKind::gif;
    const fs::path list = segments.folder / "join.txt";
    write_file(list, list_of(segments, format_));
    const fs::path program = find_ffmpeg();
    TemporaryFile file(clip_);
    {
        const std::lock_guard lock(mutex_);
        if (abandoned_) throw RunError(fmt::format("'{}' was abandoned", safe_path(clip_)));
        process_.emplace(program, join_arguments(format_, list, file.path(), comment_of(mark_), sound_));
    }
    const ProcessEnd end = process_->finish();
    encoder_seconds_ += end.cpu_seconds;
    std::optional<std::string> fault;
    if (!end.ok())
        fault = fmt::format("failed ({})", end.describe());
    else if (const auto broken = fault_of_clip(file.path(), gif ? "gif" : format_.container, segments.stored))
        fault = fmt::format("ended with exit code 0, but the clip is not whole: {}", *broken);
    else if (gif && !add_gif_comment(file.path(), comment_of(mark_)))
        fault = "ended with exit code 0, but the clip cannot be completed";
    if (fault)
        throw RunError(fmt::format("cannot write '{}': {} {}{}{}", safe_path(clip_), safe_path(program), *fault,
                                   end.error_text.empty() ? "" : ":\n", end.error_text));
    file.commit();
}

void SegmentJoiner::abandon() {
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
    if (process_) process_->kill();
}

bool clip_has_mark(const fs::path& clip, const std::string& mark) {
    std::error_code error;
    if (!fs::is_regular_file(clip, error)) return false;
    std::ifstream file(clip, std::ios::binary);
    const std::string comment = comment_of(mark);
    const std::boyer_moore_horspool_searcher searcher(comment.begin(), comment.end());
    constexpr std::size_t block = 1 << 20;
    for (std::string window; file;) {
        const std::size_t kept = std::min(window.size(), comment.size() - 1);
        window.erase(0, window.size() - kept);
        window.resize(kept + block);
        file.read(window.data() + kept, block);
        window.resize(kept + std::size_t(file.gcount()));
        if (std::search(window.begin(), window.end(), searcher) != window.end()) return true;
    }
    return false;
}

}  // namespace tumble
