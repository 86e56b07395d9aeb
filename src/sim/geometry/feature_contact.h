// Manifolds from the features that a separating-axis search selects: face against face, edge against edge.
// All in the frame of shape A; the caller's pose transforms to the world.
#pragma once

#include "sim/geometry/collide.h"

namespace tumble {

/// Labels of edges that lie on side i of the reference face, distinct from those of the incident polygon (its edge
/// index).
constexpr std::uint32_t side_label(std::uint32_t i) { return 0x80000u | i; }

/// Prefix of the feature ids of a face manifold; Manifold::on_b() reads it.
inline std::uint64_t face_feature(bool reference_on_b, std::uint32_t reference_label) {
    return (std::uint64_t(reference_on_b) << 63) | (std::uint64_t(reference_label) << 42);
}

/// The frame of shape A in the world, and the destination of its manifolds.
struct ManifoldSink {
    const Pose& frame;
    double margin;  // m
    CollisionScratch& scratch;
    std::vector<Manifold>& out;
};

/// Clips the polygon to the inside of all side planes of the reference polygon, counterclockwise about `normal`
/// (Sutherland and Hodgman 1974). `spare` is working space.
void clip_to_prism(const std::vector<Vec3>& reference, const Vec3& normal, std::vector<ClipVertex>& polygon,
                   std::vector<ClipVertex>& spare);

struct ReferenceFace {
    Vec3 normal;          // outward
    std::uint32_t label;  // distinguishes faces in the feature ids
    bool on_b;            // turns the manifold's normal so that it points away from A
};

/// Clips scratch.incident (with scratch.labels for its vertices) to the prism of scratch.reference and keeps points
/// with less than the margin to the reference plane. `must_touch`: the shapes are known to overlap, so that the deepest
/// vertex is kept if clipping leaves no point.
void add_face_manifold(const ReferenceFace& reference, bool must_touch, const ManifoldSink& sink);

struct EdgeSegment {
    Vec3 tail, head;
    std::uint64_t index;  // of the edge in its shape
};

/// One point, halfway between the nearest points of two segments; `normal` points away from A.
void add_edge_manifold(const EdgeSegment& a, const EdgeSegment& b, const Vec3& normal, double separation,
                       const ManifoldSink& sink);

}  // namespace tumble
