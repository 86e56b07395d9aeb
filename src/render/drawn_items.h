// What is drawn, as corners in space: one item a body (planes and hidden ones are empty), then one a cord.
#pragma once

#include "render/body_looks.h"
#include "render/camera_view.h"
#include "sim/snapshot.h"

#include <array>
#include <vector>

namespace tumble {

struct DrawnItem {
    std::array<Vec3, 8> corners;   // of a box around it, relative to the eye: corner i is on the high side of axis k
                                   // when bit k of i is set
    Vec3 center;                   // of a ball around it, relative to the eye
    double radius = -1.0;          // m; negative: nothing is drawn
    bool exists() const { return radius >= 0.0; }
};

std::vector<DrawnItem> make_drawn_items(const SceneDescription& scene, const SceneLooks& looks,
                                        const Snapshot& snapshot, const CameraView& view);

/// The corners of a box.
std::array<Vec3, 8> box_corners(const Vec3& center, const Mat3& axes, const Vec3& half_size);

}  // namespace tumble
