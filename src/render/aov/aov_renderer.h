// Computes the AOVs of a frame (aov_kind.h) at pixel centers, without antialiasing: on the CPU, in double precision,
// from the shapes themselves, without OpenGL. The poses are the true ones, not the filtered ones of pose_filter.h.
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

/// The poses of a frame and, if motion is needed, of the next one.
struct AovPoses {
    Snapshot now;
    std::optional<Snapshot> next;
};

/// The requested AOVs; the others are empty. Top row first, channels of a pixel adjacent.
struct AovFrame {
    PinholeCamera camera;
    std::vector<float> depth;                // 1 per pixel
    std::vector<float> normal;               // 3 per pixel
    std::vector<std::int32_t> segmentation;  // 1 per pixel
    std::vector<float> motion;               // 2 per pixel: columns, rows
    std::vector<std::uint8_t> albedo;        // 3 per pixel: red, green, blue
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
    WaterSurface water_;
};

/// Detects frames whose values equal the values of the frame before, to the bit.
class AovChanges {
public:
    explicit AovChanges(const SceneDescription& scene)
        : path_(scene.camera), waves_(shows_water(scene) && !scene.water->waves.empty()) {}

    /// Call it for every frame, in order. Returns false if since the previous call neither a body nor the camera has
    /// moved, in this frame or to the next. Waves always move.
    bool follow(const AovPoses& poses);

private:
    CameraAnimation path_;
    bool waves_;
    std::optional<AovPoses> before_;
};

}  // namespace tumble
