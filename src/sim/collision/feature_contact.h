// Manifolds from the features that a separating-axis search names: face against face, edge against edge.
// Everything in the frame of shape A; the caller's pose takes it to the world.
#pragma once

#include "sim/collision/collide.h"

namespace tumble {

/// Whether two shapes are known to overlap, and deeply: beyond rounding and the seams between tiles.
enum class Overlap { none, shallow, deep };
Overlap overlap_of(double separation, double smaller_radius);

/// Clips scratch.incident (with scratch.labels for its vertices) to the prism of scratch.reference and keeps what lies
/// nearer than margin to the reference plane. `normal` is the reference face's, outward. `reference_on_b` turns the
/// manifold's normal so that it points away from A. `reference_label` tells faces apart in the feature ids.
/// Of shapes that overlap the deepest vertex comes in if clipping leaves nothing; if deeply, also if it leaves nothing that
/// touches.
void add_face_manifold(const Vec3& normal, std::uint32_t reference_label, bool reference_on_b, const Pose& frame,
                       double margin, Overlap overlap, CollisionScratch& scratch, std::vector<Manifold>& out);

/// One point between the nearest points of two segments; `normal` away from A.
void add_edge_manifold(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1, const Vec3& normal,
                       double separation, std::uint64_t edge_a, std::uint64_t edge_b, const Pose& frame,
                       std::vector<Manifold>& out);

}  // namespace tumble
