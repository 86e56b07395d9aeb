// Memory shared by a render process and the program: space for the poses of one frame, and slots, one for each frame
// that is not yet written. The slot of a frame has its pixels for ffmpeg, its PNG file and its AOVs. The memory has no
// name, so that it disappears with the processes.
#pragma once

#include "output/video_format.h"
#include "render/aov/aov_renderer.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace tumble {

/// The outputs of every frame.
struct FrameOutputs {
    std::optional<PixelFormat> video;
    bool png = false;
    AovSet aovs;

    bool image() const { return video.has_value() || png; }
};

class SharedFrames {
public:
    /// Call it before the fork, for frames with this many blur samples. Throws RunError if there is not enough memory.
    SharedFrames(const SceneDescription& scene, const FrameOutputs& outputs, int slots, int max_blur_samples);
    ~SharedFrames();
    SharedFrames(const SharedFrames&) = delete;
    SharedFrames& operator=(const SharedFrames&) = delete;

    /// Writes one sample of the next frame to draw: time, origins and orientations, and the center of mass of the body
    /// that the camera follows. There is space for one frame.
    void write_poses(std::size_t sample, const Snapshot& snapshot);
    void read_poses(std::size_t sample, Snapshot& snapshot) const;

    /// Writes poses for the AOVs: those of the next frame only if motion is requested.
    void write_aov_poses(const AovPoses& poses);
    void read_aov_poses(AovPoses& poses) const;

    std::span<std::byte> video(int slot) const { return region(slot, video_at_, video_size_); }
    std::span<std::byte> png(int slot) const { return region(slot, png_at_, png_size_); }  // space for the largest file
    std::span<std::byte> aovs(int slot) const {
        return region(slot, aovs_at_, aovs_size_);
    }  // space for the largest file

    /// Stores the reason of a failure; a long one is cut.
    void write_error(const std::string& text);
    std::string error_text() const;

private:
    std::span<std::byte> region(int slot, std::size_t at, std::size_t size) const {
        return {memory_ + slots_at_ + std::size_t(slot) * slot_size_ + at, size};
    }

    std::span<double> poses(std::size_t sample) const {
        return {reinterpret_cast<double*>(memory_ + error_text_size + sample * poses_size_),
                poses_size_ / sizeof(double)};
    }

    static constexpr std::size_t error_text_size = 4096;
    std::optional<std::size_t> followed_;
    bool motion_;
    std::size_t bodies_, max_blur_samples_, poses_size_, slots_at_, video_at_, video_size_, png_at_, png_size_,
        aovs_at_, aovs_size_, slot_size_, size_;
    std::byte* memory_;
};

}  // namespace tumble
