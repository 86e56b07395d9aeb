// Manifolds from the features that a separating-axis search names: face against face, edge against edge.
// Everything in the frame of shape A; the caller's pose takes it to the world.
#pragma once

#include "sim/geometry/collide.h"

namespace tumble {

/// What the ids of a face manifold's features begin with; Manifold::on_b() reads it.
inline std::uint64_t face_feature(bool reference_on_b, std::uint32_t reference_label) {
    return (std::uint64_t(reference_on_b) << 63) | (std::uint64_t(reference_label) << 42);
}

/// Clips scratch.incident (with scratch.labels for its vertices) to the prism of scratch.reference and keeps what lies
/// nearer than margin to the reference plane. `normal` is the reference face's, outward. `reference_on_b` turns the
/// manifold's normal so that it points away from A. `reference_label` tells faces apart in the feature ids.
/// `must_touch`: the shapes are known to overlap, so that the deepest vertex stands in if clipping leaves nothing.
void add_face_manifold(const Vec3& normal, std::uint32_t reference_label, bool reference_on_b, const Pose& frame,
                       double margin, bool must_touch, CollisionScratch& scratch, std::vector<Manifold>& out);

/// One point between the nearest points of two segments; `normal` away from A.
void add_edge_manifold(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1, const Vec3& normal,
                       double separation, std::uint64_t edge_a, std::uint64_t edge_b, const Pose& frame,
                       std::vector<Manifold>& out);

}  // namespace tumble
