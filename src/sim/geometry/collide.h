// The narrow phase: exact manifolds between two posed shapes, for every pair of shapes in either order.
#pragma once

#include "sim/geometry/manifold.h"
#include "sim/geometry/mesh_sidedness.h"
#include "sim/geometry/shapes/shape.h"

#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// Choice between axes that separate about equally well. steady: the same axis from step to step, for lasting contacts.
/// nearest: the better axis to the last digits, for the time of an impact.
enum class AxisChoice { steady, nearest };

/// Corner of a polygon that is clipped, with labels of its features (feature_contact.h).
struct ClipVertex {
    Vec3 position;
    std::uint64_t feature = 0;  // the vertex's own label
    std::uint32_t edge = 0;     // label of the polygon edge that starts here
};

/// Working space, kept from pair to pair so that the loop allocates nothing.
struct CollisionScratch {
    AxisChoice choice = AxisChoice::steady;
    // For two boxes: in, the separating axis of the last query, tried first; out, that of this one. And a lower bound
    // (m) of the gap between the shapes, where no manifold was found and a bound is known.
    std::uint32_t axis = 0;
    double gap = 0.0;
    // m, world: displacement of B relative to A in the coming step; selects one of two faces that the shapes slide over
    Vec3 displacement = Vec3::Zero();
    bool turning = false;  // true if one of the bodies rotates fast (rolling_turn (narrow_phase.cpp))
    bool on_ball = false;  // true if a manifold found lies on a curved surface. Cleared by the caller, as is gap
    // The pair's manifolds of the last step, and the part index of the present one (Manifold::part): a manifold on B's
    // face stays on B's face when A's face separates equally well.
    std::span<const Manifold> before;
    std::uint32_t part = 0;
    bool was_on_b() const;
    std::vector<ContactPoint> points;
    // reduced points of all manifolds found, in order: Manifold::first_reduced. Cleared by the caller
    std::vector<ContactPoint> reduced;
    std::vector<ClipVertex> polygon, spare;
    std::vector<Vec3> reference, incident;
    std::vector<std::uint32_t> labels, vertices, edges_a, edges_b;
    struct MeshHit {
        double distance;
        std::uint32_t triangle;
        int feature;  // 0 face, 1 to 3 edge, 4 to 6 vertex
        Vec3 point;
    };
    std::vector<MeshHit> hits;
    SideScratch sides;
    std::vector<std::pair<std::uint32_t, double>> at_edges, at_vertices;
    std::vector<std::uint32_t> used_vertices, used_edges;
    // indices of the near parts of the last and of the last but one compound that was split
    std::vector<std::uint32_t> near_parts[2];
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [choice, axis, gap, displacement, turning, on_ball, before, part, points, reduced, polygon, spare,
               reference, incident, labels, vertices, edges_a, edges_b, hits, sides, at_edges, at_vertices,
               used_vertices, used_edges, near_parts] = self;
        archive.rebuilt(choice);
        archive.any(axis, part);  // an axis that no box has is not tried
        archive.keep(gap, displacement, turning, on_ball);
        archive.scratch(before, points, reduced, polygon, spare, reference, incident, labels, vertices, edges_a,
                        edges_b, hits, sides, at_edges, at_vertices, used_vertices, used_edges, near_parts);
    }
};

/// Poses of two shapes A and B, and the destination of their manifolds: points with a gap below `margin` (m).
struct CollisionQuery {
    const Pose &pose_a, &pose_b;
    double margin;
    CollisionScratch& scratch;
    std::vector<Manifold>& out;

    CollisionQuery swapped() const { return {pose_b, pose_a, margin, scratch, out}; }
};

/// Appends the manifolds of the pair. Normals point away from `a`; the caller sets the body indices. Two half-spaces,
/// two meshes, and a half-space with a mesh give no manifolds: they cannot move.
void collide(const CollisionShape& a, const CollisionShape& b, const CollisionQuery& query);

// The routines per pair of kinds, each with its first shape as A: collide() finds the one that takes its shapes.
void collide_pair(const HalfSpace& a, const Ball& b, const CollisionQuery& query);
void collide_pair(const HalfSpace& a, const Polyhedron& b, const CollisionQuery& query);
void collide_pair(const Ball& a, const Ball& b, const CollisionQuery& query);
void collide_pair(const Polyhedron& a, const Ball& b, const CollisionQuery& query);
void collide_pair(const Polyhedron& a, const Polyhedron& b, const CollisionQuery& query);
/// Precondition: both are boxes (Polyhedron::is_box). Gives the result of the general routine in a fraction of the
/// time.
void collide_boxes(const Polyhedron& a, const Polyhedron& b, const CollisionQuery& query);
void collide_pair(const CollisionMesh& a, const Ball& b, const CollisionQuery& query);
void collide_pair(const CollisionMesh& a, const Polyhedron& b, const CollisionQuery& query);
void collide_pair(const HalfSpace& a, const CurvedBody& b, const CollisionQuery& query);
void collide_pair(const Ball& a, const CurvedBody& b, const CollisionQuery& query);
void collide_pair(const Polyhedron& a, const CurvedBody& b, const CollisionQuery& query);
void collide_pair(const CurvedBody& a, const CurvedBody& b, const CollisionQuery& query);
void collide_pair(const CollisionMesh& a, const CurvedBody& b, const CollisionQuery& query);

}  // namespace tumble
