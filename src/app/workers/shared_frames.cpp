#include "app/workers/shared_frames.h"

#include "app/files/aov_file.h"
#include "core/check.h"
#include "core/error.h"
#include "output/png_writer.h"

#include <fmt/format.h>

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace tumble {
namespace {

constexpr std::size_t page = 4096;            // bytes: regions with different writers are on separate pages
constexpr std::size_t numbers_of_sample = 4;  // time; x, y, z
constexpr std::size_t numbers_of_body = 7;    // x, y, z; x, y, z, w

std::size_t whole_pages(std::size_t bytes) { return (bytes + page - 1) / page * page; }

}  // namespace

SharedFrames::SharedFrames(const SceneDescription& scene, const FrameOutputs& outputs, int slots, int max_blur_samples)
    : followed_(scene.camera.follow),
      motion_(outputs.aovs.has(Aov::motion)),
      bodies_(scene.bodies.size()),
      max_blur_samples_(std::size_t(max_blur_samples)),
      poses_size_((numbers_of_sample + bodies_ * numbers_of_body) * sizeof(double)),
      slots_at_(error_text_size + whole_pages((max_blur_samples_ + (outputs.aovs.empty() ? 0
                                                                    : motion_            ? 2
                                                                                         : 1)) *
                                              poses_size_)),
      video_at_(0),
      video_size_(outputs.video ? frame_bytes(*outputs.video, scene.output.width, scene.output.height) : 0),
      png_at_(whole_pages(video_size_)),
      png_size_(outputs.png ? png_bytes_bound(scene.output.width, scene.output.height) : 0),
      aovs_at_(png_at_ + whole_pages(png_size_)),
      aovs_size_(outputs.aovs.empty() ? 0 : aov_file_bound(outputs.aovs, scene.output.width, scene.output.height)),
      slot_size_(aovs_at_ + whole_pages(aovs_size_)),
      size_(slots_at_ + slot_size_ * std::size_t(slots)) {
    // Pages that are never written take no memory, so the space for a PNG file may be far larger than the file.
    void* const memory =
        mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED)
        throw RunError(
            fmt::format("no memory for frames ({} MiB): {}", size_ >> 20, std::generic_category().message(errno)));
    memory_ = static_cast<std::byte*>(memory);
}

SharedFrames::~SharedFrames() { munmap(memory_, size_); }

void SharedFrames::write_poses(std::size_t sample, const Snapshot& snapshot) {
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), bodies_);
    double* to = poses(sample).data();
    *to++ = snapshot.time;
    if (followed_) std::copy_n(snapshot.bodies[*followed_].center_of_mass.data(), 3, to);
    to += 3;
    for (const BodyState& body : snapshot.bodies) {
        std::copy_n(body.origin.data(), 3, to);
        std::copy_n(body.orientation.coeffs().data(), 4, to + 3);
        to += numbers_of_body;
    }
}

void SharedFrames::read_poses(std::size_t sample, Snapshot& snapshot) const {
    snapshot.bodies.resize(bodies_);
    const double* from = poses(sample).data();
    snapshot.time = *from++;
    if (followed_) std::copy_n(from, 3, snapshot.bodies[*followed_].center_of_mass.data());
    from += 3;
    for (BodyState& body : snapshot.bodies) {
        std::copy_n(from, 3, body.origin.data());
        std::copy_n(from + 3, 4, body.orientation.coeffs().data());
        from += numbers_of_body;
    }
}

void SharedFrames::write_aov_poses(const AovPoses& poses) {
    write_poses(max_blur_samples_, poses.now);
    TUMBLE_CHECK_EQ(poses.next.has_value(), motion_);
    if (motion_) write_poses(max_blur_samples_ + 1, *poses.next);
}

void SharedFrames::read_aov_poses(AovPoses& poses) const {
    read_poses(max_blur_samples_, poses.now);
    if (motion_) read_poses(max_blur_samples_ + 1, poses.next.emplace());
}

void SharedFrames::write_error(const std::string& text) {
    const std::size_t size = std::min(text.size(), error_text_size - 1);
    std::memcpy(memory_, text.data(), size);
    memory_[size] = std::byte{0};
}

std::string SharedFrames::error_text() const { return reinterpret_cast<const char*>(memory_); }

}  // namespace tumble
