#include "app/workers/shared_frames.h"

#include "app/files/aov_file.h"
#include "core/check.h"
#include "core/error.h"
#include "output/png_writer.h"
#include "render/camera/camera_animation.h"

#include <fmt/format.h>

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace tumble {
namespace {

constexpr std::size_t page = 4096;          // bytes: regions with different writers are on separate pages
constexpr std::size_t numbers_of_body = 8;  // x, y, z; x, y, z, w; 1 if absent

// Bytes for the shapes of an overlay: a million arrows. Pages that are never written take no memory.
constexpr std::size_t overlay_space = 128 << 20;

std::size_t whole_pages(std::size_t bytes) { return (bytes + page - 1) / page * page; }

}  // namespace

SharedFrames::SharedFrames(const Composition& composition, const FrameOutputs& outputs, int slots, int max_blur_samples)
    : motion_(outputs.aovs.has(Aov::motion)) {
    for (const ClipPanel& panel : composition.panels)
        panels_.push_back(add_region(*panel.scene, 1 + std::size_t(max_blur_samples)));
    for (const ClipPanel& panel : composition.panels) {
        overlays_at_.emplace_back();
        if (!panel.overlay) continue;
        overlays_at_.back() = slots_at_;
        slots_at_ += whole_pages(sizeof(std::size_t) + overlay_space);
    }
    if (!outputs.aovs.empty()) aov_poses_ = add_region(*composition.aov_scene, motion_ ? 2 : 1);
    const int width = composition.width, height = composition.height;
    video_at_ = 0;
    video_size_ = outputs.video ? frame_bytes(*outputs.video, width, height) : 0;
    png_at_ = whole_pages(video_size_);
    png_size_ =
        outputs.png ? png_bytes_bound(width, height, outputs.transparent ? PngAlpha::kept : PngAlpha::dropped) : 0;
    aovs_at_ = png_at_ + whole_pages(png_size_);
    const OutputSettings& aov_output = composition.aov_scene->output;
    aovs_size_ = outputs.aovs.empty() ? 0 : aov_file_bound(outputs.aovs, aov_output.width, aov_output.height);
    slot_size_ = aovs_at_ + whole_pages(aovs_size_);
    size_ = slots_at_ + slot_size_ * std::size_t(slots);
    // Pages that are never written take no memory, so the space for a PNG file may be far larger than the file.
    void* const memory =
        mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED)
        throw RunError(
            fmt::format("no memory for frames ({} MiB): {}", size_ >> 20, std::generic_category().message(errno)));
    memory_ = static_cast<std::byte*>(memory);
}

SharedFrames::~SharedFrames() { munmap(memory_, size_); }

std::size_t SharedFrames::PoseRegion::size_of_sample() const {
    return 1 + 3 * followed.size() + bodies * numbers_of_body;  // the time; centers of mass; poses
}

/// Reserves space in front of the slots.
SharedFrames::PoseRegion SharedFrames::add_region(const SceneDescription& scene, std::size_t samples) {
    const PoseRegion region{followed_bodies(scene.camera), scene.bodies.size(), slots_at_};
    slots_at_ += whole_pages((1 + samples * region.size_of_sample()) * sizeof(double));
    return region;
}

double* SharedFrames::sample(const PoseRegion& region, std::size_t index) const {
    return count(region) + 1 + index * region.size_of_sample();
}

void SharedFrames::write(const PoseRegion& region, std::size_t index, const Snapshot& snapshot) {
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), region.bodies);
    double* to = sample(region, index);
    *to++ = snapshot.time;
    for (const std::size_t body : region.followed) {
        std::copy_n(snapshot.bodies[body].center_of_mass.data(), 3, to);
        to += 3;
    }
    for (const BodyState& body : snapshot.bodies) {
        std::copy_n(body.origin.data(), 3, to);
        std::copy_n(body.orientation.coeffs().data(), 4, to + 3);
        to[7] = body.absent ? 1.0 : 0.0;
        to += numbers_of_body;
    }
}

void SharedFrames::read(const PoseRegion& region, std::size_t index, Snapshot& snapshot) const {
    snapshot.bodies.resize(region.bodies);
    const double* from = sample(region, index);
    snapshot.time = *from++;
    for (const std::size_t body : region.followed) {
        std::copy_n(from, 3, snapshot.bodies[body].center_of_mass.data());
        from += 3;
    }
    for (BodyState& body : snapshot.bodies) {
        std::copy_n(from, 3, body.origin.data());
        std::copy_n(from + 3, 4, body.orientation.coeffs().data());
        body.absent = from[7] != 0.0;
        from += numbers_of_body;
    }
}

void SharedFrames::write_poses(std::size_t panel, const PanelPoses& poses) {
    *count(panels_[panel]) = double(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) write(panels_[panel], i, poses[i]);
}

std::size_t SharedFrames::moments(std::size_t panel) const { return std::size_t(*count(panels_[panel])); }

void SharedFrames::read_poses(std::size_t panel, std::size_t sample, Snapshot& snapshot) const {
    read(panels_[panel], sample, snapshot);
}

void SharedFrames::write_overlay(std::size_t panel, std::span<const std::byte> shapes) {
    if (shapes.size() > overlay_space)
        throw RunError(fmt::format(
            "the overlays of a frame take {} MiB, and the limit is {}: show fewer bodies, or set trail_time",
            shapes.size() >> 20, overlay_space >> 20));
    std::byte* const to = memory_ + *overlays_at_[panel];
    const std::size_t size = shapes.size();
    std::memcpy(to, &size, sizeof size);
    std::ranges::copy(shapes, to + sizeof size);
}

std::span<const std::byte> SharedFrames::overlay(std::size_t panel) const {
    const std::byte* const from = memory_ + *overlays_at_[panel];
    std::size_t size = 0;
    std::memcpy(&size, from, sizeof size);
    return {from + sizeof size, size};
}

void SharedFrames::write_aov_poses(const AovPoses& poses) {
    write(*aov_poses_, 0, poses.now);
    TUMBLE_CHECK_EQ(poses.next.has_value(), motion_);
    if (motion_) write(*aov_poses_, 1, *poses.next);
}

void SharedFrames::read_aov_poses(AovPoses& poses) const {
    read(*aov_poses_, 0, poses.now);
    if (motion_) read(*aov_poses_, 1, poses.next.emplace());
}

void SharedFrames::write_frame(const MotionBlurFrame& frame_poses) {
    for (std::size_t i = 0; i < frame_poses.panels.size(); ++i) write_poses(i, frame_poses.panels[i]);
    if (!frame_poses.panels.empty())
        for (std::size_t i = 0; i < frame_poses.overlays.size(); ++i)
            if (!frame_poses.overlays[i].empty()) write_overlay(i, frame_poses.overlays[i]);
    if (frame_poses.aovs) write_aov_poses(*frame_poses.aovs);
}

void SharedFrames::write_error(const std::string& text) {
    const std::size_t size = std::min(text.size(), error_text_size - 1);
    std::memcpy(memory_, text.data(), size);
    memory_[size] = std::byte{0};
}

std::string SharedFrames::error_text() const { return reinterpret_cast<const char*>(memory_); }

}  // namespace tumble
