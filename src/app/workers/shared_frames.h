// Memory shared by a render process and the program: space for the poses of one frame, and slots, one for each frame
// that is not yet written. The slot of a frame has its pixels for ffmpeg, its PNG file and its AOVs. The memory has no
// name, so that it disappears with the processes.
#pragma once

#include "app/composition/composition.h"
#include "app/workers/motion_blur_frame.h"
#include "output/video_format.h"
#include "render/aov/aov_renderer.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// The outputs of every frame.
struct FrameOutputs {
    std::optional<PixelFormat> video;
    bool png = false;
    AovSet aovs;
    bool transparent = false;  // images have alpha: with RenderOptions::transparent
    std::string png_mark{};    // in each PNG file (png_mark_keyword), if not empty
    std::string aov_mark{};    // in each AOV file

    bool image() const { return video.has_value() || png; }
};

class SharedFrames {
public:
    /// Call it before the fork, for frames with this many blur samples. Throws RunError if there is not enough memory.
    SharedFrames(const Composition& composition, const FrameOutputs& outputs, int slots, int max_blur_samples);
    ~SharedFrames();
    SharedFrames(const SharedFrames&) = delete;
    SharedFrames& operator=(const SharedFrames&) = delete;

    /// Writes the samples of a panel of the next frame to draw: times, origins and orientations, and the center of mass
    /// of the body that the camera follows. There is space for one frame.
    void write_poses(std::size_t panel, const PanelPoses& poses);
    std::size_t moments(std::size_t panel) const;
    void read_poses(std::size_t panel, std::size_t sample, Snapshot& snapshot) const;

    /// All that the next frame is made from.
    void write_frame(const MotionBlurFrame& frame_poses);

    /// The shapes over a panel of the next frame (OverlayFrame), if it has an overlay. Throws RunError if they do not
    /// fit.
    void write_overlay(std::size_t panel, std::span<const std::byte> shapes);
    std::span<const std::byte> overlay(std::size_t panel) const;

    /// Writes poses for the AOVs: poses of the next frame only if motion is requested.
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

    /// The poses of one scene: the number of samples, then the samples.
    struct PoseRegion {
        std::vector<std::size_t> followed;  // by cameras
        std::size_t bodies, at;             // `at`: bytes from the start of the memory
        std::size_t size_of_sample() const;
    };
    PoseRegion add_region(const SceneDescription& scene, std::size_t samples);
    double* count(const PoseRegion& region) const { return reinterpret_cast<double*>(memory_ + region.at); }
    double* sample(const PoseRegion& region, std::size_t index) const;
    void write(const PoseRegion& region, std::size_t index, const Snapshot& snapshot);
    void read(const PoseRegion& region, std::size_t index, Snapshot& snapshot) const;

    static constexpr std::size_t error_text_size = 4096;
    bool motion_;
    std::size_t slots_at_ = error_text_size;
    std::vector<PoseRegion> panels_;
    std::vector<std::optional<std::size_t>> overlays_at_;  // by panel: the number of bytes, then these
    std::optional<PoseRegion> aov_poses_;
    std::size_t video_at_, video_size_, png_at_, png_size_, aovs_at_, aovs_size_, slot_size_, size_;
    std::byte* memory_;
};

}  // namespace tumble
