// Manifolds from the features that a separating-axis search selects: face against face, edge against edge.
// All in the frame of shape A; the caller's pose transforms to the world.
#pragma once

#include "sim/geometry/collide.h"

namespace tumble {

/// Prefix of the feature ids of a face manifold; Manifold::on_b() reads it.
inline std::uint64_t face_feature(bool reference_on_b, std::uint32_t reference_label) {
    return (std::uint64_t(reference_on_b) << 63) | (std::uint64_t(reference_label) << 42);
}

/// Clips scratch.incident (with scratch.labels for its vertices) to the prism of scratch.reference and keeps points
/// with less than `margin` to the reference plane.
/// - `normal`: outward normal of the reference face.
/// - `reference_on_b`: turns the manifold's normal so that it points away from A.
/// - `reference_label`: distinguishes faces in the feature ids.
/// - `must_touch`: the shapes are known to overlap, so that the deepest vertex is kept if clipping leaves no point.
void add_face_manifold(const Vec3& normal, std::uint32_t reference_label, bool reference_on_b, const Pose& frame,
                       double margin, bool must_touch, CollisionScratch& scratch, std::vector<Manifold>& out);

/// One point, halfway between the nearest points of two segments; `normal` points away from A.
void add_edge_manifold(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1, const Vec3& normal,
                       double separation, std::uint64_t edge_a, std::uint64_t edge_b, const Pose& frame,
                       std::vector<Manifold>& out);

}  // namespace tumble
