// A clip that survives the end of its run at any moment. It is written as segments of 0.8 s, each an encoded
// file of its own in a folder beside the clip ("clip.mp4.parts"); the last step joins them. A later run with the same
// scene, version and settings goes on after the last whole segment. The bytes of a segment depend on its frames only,
// so the clip is the same however often its run was ended.
#pragma once

#include "app/files/clip_sink.h"
#include "app/files/frame_folder.h"
#include "app/files/frame_set.h"
#include "app/resume/frame_identity.h"
#include "output/segment_joiner.h"

#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

namespace tumble {

struct ClipPicture {
    int width, height;  // pixels
    double fps;         // of the frames
};

class SegmentedClip : public ClipSink {
public:
    /// Looks for the segments of an earlier run, and writes nothing. `identity`: of the frames. `frames`: contiguous.
    /// `sound`: the clip has one; segments have none, so that segments of a clip without sound serve too.
    /// Throws InputError if the folder of segments is of another clip, or if the clip is written in place.
    SegmentedClip(const std::filesystem::path& clip, const ClipPicture& picture, const ClipOptions& options,
                  const FrameIdentity& identity, const FrameSet& frames, bool sound);
    ~SegmentedClip() override;

    /// The frames that no segment has. If the clip itself is finished, there are none.
    const FrameSet& missing() const { return missing_; }
    bool finished() const { return finished_; }

    /// A WAV file for the clip; segments have no sound. Before finish().
    void set_sound(const std::filesystem::path& file) { joiner_.set_sound(file); }

    /// Makes the folder of segments and holds it. Throws RunError. Not if the clip is finished.
    void open();

    void write(std::int64_t frame, std::shared_ptr<const std::byte> pixels, bool repeated) override;
    void finish() override;
    void abandon() override;
    double encoder_seconds() const override { return encoder_seconds_; }
    std::int64_t frames_in_clip() const override;
    std::int64_t frames_stored() const override { return stored_; }

private:
    struct Segment {
        std::int64_t first, end;  // frames
        std::filesystem::path file, seal;
    };
    Segment segment(std::int64_t number) const;
    std::int64_t segment_count() const;
    std::optional<std::int64_t> stored_in(const Segment& segment) const;
    void begin_segment(std::int64_t number);
    void end_segment();
    void wait_for_end();
    void remove_folder();

    std::filesystem::path clip_, folder_;
    ClipPicture picture_;
    ClipOptions options_;
    VideoFormat format_;
    FrameIdentity identity_;
    FrameSet frames_, missing_;
    std::int64_t segment_frames_;
    bool finished_ = false;
    std::int64_t stored_ = 0;
    double encoder_seconds_ = 0.0;
    SegmentJoiner joiner_;

    std::optional<FrameFolder> held_;
    std::int64_t current_ = -1;  // the segment that is written
    std::shared_ptr<const std::byte> last_;
    std::mutex mutex_;  // guards abandon() against changes of the writers
    bool abandoned_ = false;
    std::shared_ptr<VideoWriter> writer_, ending_;
    std::future<double> end_;  // of the segment before, which ffmpeg completes meanwhile
};

}  // namespace tumble
