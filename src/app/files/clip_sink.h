// Where the frames of a clip go: one encoder (WholeClip), or segments of 0.8 s, after which a later run goes on
// (resume/segmented_clip.h).
#pragma once

#include "output/video_writer.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

namespace tumble {

class ClipSink {
public:
    ClipSink() = default;
    virtual ~ClipSink() = default;
    ClipSink(const ClipSink&) = delete;
    ClipSink& operator=(const ClipSink&) = delete;

    /// The next frame, ascending, as the bytes of a VideoPixels; held until the frame after it. `repeated`: the same
    /// image as the frame before it. Throws RunError with ffmpeg's message.
    virtual void write(std::int64_t frame, std::shared_ptr<const std::byte> pixels, bool repeated) = 0;

    /// Completes the clip and gives it its name. Throws RunError.
    virtual void finish() = 0;

    /// Stops at once, from any thread; a waiting write() then throws an error.
    virtual void abandon() = 0;

    // Valid after finish().
    virtual double encoder_seconds() const = 0;       // CPU time of ffmpeg, s
    virtual std::int64_t frames_in_clip() const = 0;  // that the clip shows
    virtual std::int64_t frames_stored() const = 0;
};

class WholeClip : public ClipSink {
public:
    /// As for VideoWriter.
    WholeClip(const std::filesystem::path& clip, int width, int height, double fps, const ClipOptions& options)
        : video_(clip, width, height, fps, options) {}

    void write(std::int64_t, std::shared_ptr<const std::byte> pixels, bool repeated) override {
        if (repeated)
            video_.repeat();
        else
            video_.write(std::move(pixels));
    }
    void finish() override { video_.finish(); }
    void abandon() override { video_.abandon(); }
    double encoder_seconds() const override { return video_.encoder_seconds(); }
    std::int64_t frames_in_clip() const override { return video_.frames_in_clip(); }
    std::int64_t frames_stored() const override { return video_.frames_stored(); }

private:
    VideoWriter video_;
};

}  // namespace tumble
