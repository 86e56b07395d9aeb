#include "app/resume/segmented_clip.h"

#include "core/check.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "core/sha256.h"
#include "output/file_bytes.h"
#include "output/output_path.h"
#include "output/temporary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

// With the frames that are drawn while ffmpeg completes a segment, a killed run loses at most a second. Shorter ones
// cost more starts of ffmpeg, 0.2 s of CPU time each.
constexpr double segment_seconds = 0.8;
// A shorter rest goes into the segment before it: a clip of one frame has no delay for B-frames, and joined ones then
// have a gap in the decoding times.
constexpr std::int64_t shortest_part = 4;  // of a segment: a quarter

/// In whole frames of the clip's format.
std::int64_t frames_of_segment(const VideoFormat& format) {
    const double rate = double(format.rate.numerator) / double(format.rate.denominator);
    return format.frame_step * std::max(std::int64_t(1), std::int64_t(std::floor(rate * segment_seconds + 1e-9)));
}

const char* text_of(VideoQuality quality) {
    switch (quality) {
        case VideoQuality::draft:
            return "draft";
        case VideoQuality::normal:
            return "normal";
        case VideoQuality::best:
            return "best";
        case VideoQuality::small:
            return "small";
    }
    return "";
}

FrameIdentity identity_of_clip(FrameIdentity identity, const VideoFormat& format, const ClipOptions& options,
                               const FrameSet& frames) {
    identity.settings.emplace_back("format", segment_ending(format).substr(1) + " in " + format.container);
    identity.settings.emplace_back("quality", text_of(options.quality));
    identity.settings.emplace_back("variable rate", options.times == FrameTimes::longer_frames ? "yes" : "no");
    identity.settings.emplace_back("frames of the clip", frames.text());
    return identity;
}

/// The mark of the finished clip.
std::string mark_of_clip(FrameIdentity segments, bool sound) {
    if (sound) segments.settings.emplace_back("sound", "yes");
    return segments.mark();
}

}  // namespace

SegmentedClip::SegmentedClip(const fs::path& clip, const ClipPicture& picture, const ClipOptions& options,
                             const FrameIdentity& identity, const FrameSet& frames, bool sound)
    : clip_(clip),
      folder_(clip.string() + ".parts"),
      picture_(picture),
      options_(options),
      format_(video_format(clip, picture.fps, options.transparent)),
      identity_(identity_of_clip(identity, format_, options, frames)),
      frames_(frames),
      segment_frames_(frames_of_segment(format_)),
      joiner_(clip, format_, mark_of_clip(identity_, sound)) {
    TUMBLE_CHECK_EQ(frames.contiguous() && !frames.empty(), true);
    if (is_written_in_place(clip))
        throw InputError(
            fmt::format("--resume: '{}' is a pipe or device, which no later run can go on with", safe_path(clip)));
    if (const auto there = read_manifest(folder_ / "clip.json"); there && there->mark() != identity_.mark())
        throw InputError(
            {folder_.string(), 0, 0},
            fmt::format("the folder holds segments of another clip, which differs in {}; delete it to start "
                        "anew, or name another clip",
                        differences(*there, identity_)));
    finished_ = clip_has_mark(clip, mark_of_clip(identity_, sound));
    for (std::int64_t i = 0; !finished_ && i < segment_count(); ++i) {
        const Segment one = segment(i);
        if (!stored_in(one)) missing_.append(one.first, one.end);
    }
}

SegmentedClip::~SegmentedClip() {
    abandon();
    if (end_.valid()) end_.wait();
}

std::int64_t SegmentedClip::segment_count() const {
    const std::int64_t whole = frames_.count() / segment_frames_, rest = frames_.count() % segment_frames_;
    return std::max(std::int64_t(1), whole + (rest * shortest_part >= segment_frames_ ? 1 : 0));
}

std::int64_t SegmentedClip::frames_in_clip() const { return (frames_.count() - 1) / format_.frame_step + 1; }

SegmentedClip::Segment SegmentedClip::segment(std::int64_t number) const {
    const fs::path name = folder_ / fmt::format("segment_{:06}", number);
    const std::int64_t first = frames_.first() + number * segment_frames_;
    const std::int64_t end = number + 1 == segment_count() ? frames_.end() : first + segment_frames_;
    return {first, end, name.string() + segment_ending(format_), name.string() + ".sha256"};
}

/// The number of frames in the file of a whole segment; empty for another one.
std::optional<std::int64_t> SegmentedClip::stored_in(const Segment& segment) const {
    const std::optional<std::string> seal = bytes_of_file(segment.seal), file = bytes_of_file(segment.file);
    constexpr std::size_t digits = 64;
    if (!seal || !file || seal->size() < digits + 2 || seal->substr(0, digits) != sha256(*file)) return std::nullopt;
    std::int64_t stored = 0;
    const char* const last = seal->data() + seal->size() - 1;  // a line feed
    const auto [end, error] = std::from_chars(seal->data() + digits + 1, last, stored);
    if (error != std::errc() || end != last || stored < 1) return std::nullopt;
    return stored;
}

void SegmentedClip::open() {
    if (finished_) return;
    held_.emplace(folder_);
    remove_left_parts(folder_, [](std::string_view) { return true; });
    held_->set_manifest(folder_ / "clip.json", manifest_text(identity_));
    held_->write_manifest();
}

void SegmentedClip::write(std::int64_t frame, std::shared_ptr<const std::byte> pixels, bool repeated) {
    const std::int64_t number = std::min((frame - frames_.first()) / segment_frames_, segment_count() - 1);
    if (number != current_) begin_segment(number);
    // By content: whether a frame counts as repeated must not depend on where the run started.
    const std::size_t bytes = frame_bytes(format_.pixels, picture_.width, picture_.height);
    const bool same = last_ && (repeated || last_ == pixels || std::memcmp(last_.get(), pixels.get(), bytes) == 0);
    if (same) {
        writer_->repeat();
    } else {
        last_ = pixels;
        writer_->write(std::move(pixels));
    }
    if (frame + 1 == segment(number).end) end_segment();
}

void SegmentedClip::begin_segment(std::int64_t number) {
    last_.reset();
    current_ = number;
    const std::lock_guard lock(mutex_);
    if (abandoned_) throw RunError(fmt::format("'{}' was abandoned", safe_path(clip_)));
    writer_ = std::make_shared<VideoWriter>(segment(number).file, picture_.width, picture_.height, picture_.fps,
                                            segment_format(format_), options_);
}

/// ffmpeg completes the segment while the next one is written. The seal comes last: a segment without it is made again.
void SegmentedClip::end_segment() {
    wait_for_end();
    last_.reset();
    {
        const std::lock_guard lock(mutex_);
        ending_ = std::move(writer_);
    }
    end_ = std::async(std::launch::async, [writer = ending_, one = segment(current_)] {
        writer->finish();
        const std::optional<std::string> file = bytes_of_file(one.file);
        if (!file) throw RunError(fmt::format("cannot read '{}'", safe_path(one.file)));
        write_file(one.seal, fmt::format("{} {}\n", sha256(*file), writer->frames_stored()));
        return writer->encoder_seconds();
    });
}

void SegmentedClip::wait_for_end() {
    if (end_.valid()) encoder_seconds_ += end_.get();
}

void SegmentedClip::finish() {
    wait_for_end();
    if (finished_) {
        stored_ = frames_in_clip();
        // A run that was killed after the clip had its name has left the folder.
        std::error_code missing;
        if (fs::is_directory(folder_, missing)) held_.emplace(folder_);
        return remove_folder();
    }
    ClipSegments segments{folder_, {}, {}, 0};
    for (std::int64_t i = 0; i < segment_count(); ++i) {
        const Segment one = segment(i);
        const std::optional<std::int64_t> stored = stored_in(one);
        if (!stored)
            throw RunError(
                fmt::format("cannot write '{}': its segment '{}' is damaged", safe_path(clip_), safe_path(one.file)));
        segments.names.push_back(one.file.filename().string());
        segments.frames.push_back((one.end - one.first - 1) / format_.frame_step + 1);
        segments.stored += *stored;
    }
    stored_ = segments.stored;
    joiner_.join(segments);
    encoder_seconds_ += joiner_.encoder_seconds();
    finished_ = true;
    remove_folder();
}

/// The clip has its name. The next run removes the rest of a folder that a killed run left.
void SegmentedClip::remove_folder() {
    std::error_code ignored;
    for (std::int64_t i = 0; i < segment_count(); ++i) {
        fs::remove(segment(i).seal, ignored);
        fs::remove(segment(i).file, ignored);
    }
    fs::remove(folder_ / "join.txt", ignored);
    fs::remove(folder_ / "clip.json", ignored);
    // The ffmpeg of a killed run may have made its file again, after open() removed it.
    remove_left_parts(folder_, [](std::string_view) { return true; });
    held_.reset();
    fs::remove(folder_, ignored);  // if it is empty
}

void SegmentedClip::abandon() {
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
    if (writer_) writer_->abandon();
    if (ending_) ending_->abandon();
    joiner_.abandon();
}

}  // namespace tumble
