// What a drawing process and the program share: room for the poses of the frame that is drawn, and slots, one for each frame
// on its way out. Poses go in; what is made of the frame comes out: its pixels as ffmpeg takes them, its PNG file, its AOVs.
// The memory has no name, so that none is left behind however the processes end.
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

/// What is made of every frame.
struct FrameOutputs {
    std::optional<PixelForm> video;
    bool png = false;
    AovSet aovs;

    bool picture() const { return video.has_value() || png; }
};

class SharedFrames {
public:
    /// Before the fork, for frames of so many moments. Throws RunError when there is not enough memory.
    SharedFrames(const SceneDescription& scene, const FrameOutputs& forms, int slots, int most_moments);
    ~SharedFrames();
    SharedFrames(const SharedFrames&) = delete;
    SharedFrames& operator=(const SharedFrames&) = delete;

    /// Of one moment of the frame to draw next: its time, origins and orientations, and the center of mass of the body that
    /// the camera follows, which is all that drawing needs. There is room for one frame's.
    void write_poses(std::size_t moment, const Snapshot& snapshot);
    void read_poses(std::size_t moment, Snapshot& snapshot) const;

    /// Of the AOVs: those of the next frame only where the forms want motion.
    void write_aov_poses(const AovPoses& poses);
    void read_aov_poses(AovPoses& poses) const;

    std::span<std::byte> video(int slot) const { return part(slot, video_at_, video_size_); }
    std::span<std::byte> png(int slot) const { return part(slot, png_at_, png_size_); }   // room for the largest
    std::span<std::byte> aovs(int slot) const { return part(slot, aovs_at_, aovs_size_); }   // likewise

    /// Why a frame failed; cut short where it is long.
    void write_words(const std::string& words);
    std::string words() const;

private:
    std::span<std::byte> part(int slot, std::size_t at, std::size_t size) const {
        return {memory_ + slots_at_ + std::size_t(slot) * slot_size_ + at, size};
    }

    std::span<double> poses(std::size_t moment) const {
        return {reinterpret_cast<double*>(memory_ + words_size + moment * poses_size_), poses_size_ / sizeof(double)};
    }

    static constexpr std::size_t words_size = 4096;
    std::optional<std::size_t> followed_;
    bool motion_;
    std::size_t bodies_, most_moments_, poses_size_, slots_at_, video_at_, video_size_, png_at_, png_size_, aovs_at_, aovs_size_,
        slot_size_, size_;
    std::byte* memory_;
};

}  // namespace tumble
