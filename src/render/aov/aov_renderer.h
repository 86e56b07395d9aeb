// From poses to the values of a frame beside its colors (aov_kind.h), exact for each pixel's center: no smooth edges. On
// the CPU, in double precision, from the shapes themselves; needs no OpenGL. The poses are the true ones, not those that
// are drawn (drawn_poses.h): a body that trembles by a hundredth of a pixel does so here.
#pragma once

#include "render/aov/aov_kind.h"
#include "render/aov/visibility_buffer.h"
#include "render/camera/camera_animation.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// The poses of a frame; those of the next are needed for motion only.
struct AovPoses {
    Snapshot now;
    std::optional<Snapshot> next;
};

/// The values asked for; the others are empty. Top row first, the values of a pixel next to each other.
struct AovFrame {
    PinholeCamera camera;
    std::vector<float> depth;                  // 1 a pixel
    std::vector<float> normal;                 // 3
    std::vector<std::int32_t> segmentation;    // 1
    std::vector<float> motion;                 // 2: columns, rows
    std::vector<std::uint8_t> albedo;          // 3: red, green, blue
};

class AovRenderer {
public:
    /// The scene must outlive it.
    AovRenderer(const SceneDescription& scene, const AovSet& aovs);
    AovRenderer(const AovRenderer&) = delete;
    AovRenderer& operator=(const AovRenderer&) = delete;

    /// Valid until the next call.
    const AovFrame& make(const AovPoses& poses);

private:
    PinholeCamera camera_at(const Snapshot& snapshot) const;

    const SceneDescription& scene_;
    AovSet aovs_;
    CameraAnimation path_;
    AovFrame frame_;
    std::vector<ShapeInstance> parts_;
    VisibilityBufferRenderer finder_;
};

/// Tells frames whose values are those of the frame before, to the bit.
class AovChanges {
public:
    explicit AovChanges(const SceneDescription& scene) : path_(scene.camera) {}

    /// Of every frame, in order. False: since the call before neither a body nor the camera has moved, in this frame or to
    /// the next.
    bool follow(const AovPoses& poses);

private:
    CameraAnimation path_;
    std::optional<AovPoses> before_;
};

}  // namespace tumble
