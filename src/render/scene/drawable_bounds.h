// Drawables, which are bodies and cords, their bounds, and the near plane that these allow.
#pragma once

#include "render/camera/camera.h"
#include "render/scene/render_scene.h"
#include "sim/snapshot/snapshot.h"

#include <array>
#include <vector>

namespace tumble {

struct DrawableBounds {
    Mat3 half_axes;        // of a bounding box: from its center to the centers of its high sides, m
    Vec3 center;           // of that box and of a bounding ball, m, relative to the eye
    double radius = -1.0;  // m; negative: not drawn
    /// Corners of the box, m, relative to the eye: corner i is on the high side of axis k if bit k of i is set.
    std::array<Vec3, 8> corners() const;
    /// The corners of a face; its index as in Visibility.
    std::array<Vec3, 4> face(int index) const;
    bool exists() const { return radius >= 0.0; }
};

/// A value for each body and for each cord of a scene.
template <class T>
struct PerDrawable {
    std::vector<T> bodies, cords;
};

/// A set of drawables: 1 for each that belongs to it.
using DrawableMask = PerDrawable<char>;

/// Bounds of planes and hidden bodies do not exist.
PerDrawable<DrawableBounds> make_drawables(const RenderScene& scene, const Snapshot& snapshot, const Camera& view);

/// The corners of a box.
std::array<Vec3, 8> box_corners(const Vec3& center, const Mat3& axes, const Vec3& half_size);

/// Lower bound of the depth of the visible part of a body, m.
double least_depth(const RenderBody& proxy, const BodyState& state, const BoundingBall& ball, const Camera& view);

/// Near distance: half of the nearest visible body's distance, rounded down to a power of two, so that small movements
/// do not round all depths differently.
double near_distance_for(const RenderScene& scene, const Snapshot& snapshot, const Camera& view);

}  // namespace tumble
