// Exact values per pixel beside the colors: docs/reference/aovs.md has their signs and frames. Needs no OpenGL.
#pragma once

#include "scene.h"
#include "snapshot.h"

#include <cstdint>
#include <memory>
#include <vector>

TUMBLE_BEGIN

struct AovSelection {
    bool depth = false, normal = false, segmentation = false, motion = false, albedo = false;
};

/// Arrays of the selected values, top row first, the values of a pixel next to each other; the others are empty.
struct AovFrame {
    int width = 0, height = 0;               // pixels
    std::vector<float> depth;                // 1 per pixel: m along the view axis, infinity where nothing is
    std::vector<float> normal;               // 3 per pixel: unit, world frame; 0 where nothing is
    std::vector<std::int32_t> segmentation;  // 1 per pixel: 0 where nothing is, otherwise 1 + the index of the body
    std::vector<float> motion;               // 2 per pixel: columns and rows to the point's place in the next frame
    std::vector<std::uint8_t> albedo;        // 3 per pixel: sRGB
};

/// Computes on the CPU at the scene's output size, from where the camera is at the snapshot's time.
class AovRenderer {
public:
    /// Keeps the data of the scene alive. Throws std::bad_alloc only.
    AovRenderer(const Scene& scene, const AovSelection& selection);
    ~AovRenderer();
    AovRenderer(AovRenderer&&) noexcept;
    AovRenderer& operator=(AovRenderer&&) noexcept;

    /// Throws Error (input) where the snapshot does not hold each body of the scene, or where motion is selected.
    AovFrame render(const Snapshot& snapshot);
    /// With motion: `next` is the snapshot of the next frame. Throws Error (input) like the other one.
    AovFrame render(const Snapshot& snapshot, const Snapshot& next);

private:
    struct State;
    std::unique_ptr<State> state_;
};

TUMBLE_END
