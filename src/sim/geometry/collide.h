// The narrow phase: exact manifolds between two posed shapes. Every pair of shapes is here, whichever comes first.
#pragma once

#include "sim/geometry/polygon_clipping.h"
#include "sim/geometry/collider.h"
#include "sim/geometry/manifold.h"
#include "sim/geometry/mesh_sidedness.h"

#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// Between axes that separate about equally well. steady: the same from step to step, for contacts that stay. nearest: the
/// better one to the last digits, for the moment of an impact.
enum class AxisChoice { steady, nearest };

/// Working space, kept from pair to pair so that nothing is allocated in the loop.
struct CollisionScratch {
    AxisChoice choice = AxisChoice::steady;
    // Of two boxes: the axis that kept them apart last, tried first, and in return the one that does now. And how far apart
    // (m) the shapes are at least, where nothing was found and that is known.
    std::uint32_t axis = 0;
    double gap = 0.0;
    Vec3 way = Vec3::Zero();              // m, world: of B against A in the coming step. Tells over which of two faces they slide
    bool turning = false;                 // whether one of the bodies turns fast (tuning::rolling_turn)
    bool on_ball = false;                 // whether a manifold found lies on a ball. Cleared by the caller, as gap
    // The pair's manifolds of the last step, and which part of it is looked at (Manifold::part): B's face goes on being the
    // one that the manifold lies on, though A's would do as well.
    std::span<const Manifold> before;
    std::uint32_t part = 0;
    bool was_on_b() const;
    std::vector<ContactPoint> points;
    std::vector<ContactPoint> left_out;   // of all manifolds found, in order: Manifold::first_left_out. Cleared by the caller
    std::vector<ClipVertex> polygon, spare;
    std::vector<Vec3> reference, incident;
    std::vector<std::uint32_t> labels, vertices, edges_a, edges_b;
    struct SurfaceHit {
        double distance;
        std::uint32_t triangle;
        int feature;             // 0 face, 1 to 3 edge, 4 to 6 vertex
        Vec3 point;
    };
    std::vector<SurfaceHit> hits;
    SideScratch sides;
    std::vector<std::pair<std::uint32_t, double>> at_edges, at_vertices;
    std::vector<std::uint32_t> used_vertices, used_edges;
    std::vector<std::uint32_t> near_parts[2];   // of compounds: of the last one taken apart, and of the one before
};

/// Appends the manifolds of the pair: points nearer than `margin` (m). Normals point away from `a`; body indices are
/// left to the caller. Two half-spaces, two surfaces, and a half-space with a surface never touch: they cannot move.
void collide(const CollisionShape& a, const Pose& pose_a, const CollisionShape& b, const Pose& pose_b, double margin,
             CollisionScratch& scratch, std::vector<Manifold>& out);

// The pairs behind it, each with its first shape as A.
void collide_half_space_ball(const HalfSpace& a, const Pose& pose_a, const Ball& b, const Pose& pose_b, double margin,
                             std::vector<Manifold>& out);
void collide_half_space_polyhedron(const HalfSpace& a, const Pose& pose_a, const Polyhedron& b, const Pose& pose_b,
                                   double margin, CollisionScratch& scratch, std::vector<Manifold>& out);
void collide_balls(const Ball& a, const Pose& pose_a, const Ball& b, const Pose& pose_b, double margin,
                   std::vector<Manifold>& out);
void collide_polyhedron_ball(const Polyhedron& a, const Pose& pose_a, const Ball& b, const Pose& pose_b, double margin,
                             std::vector<Manifold>& out);
void collide_polyhedra(const Polyhedron& a, const Pose& pose_a, const Polyhedron& b, const Pose& pose_b, double margin,
                       CollisionScratch& scratch, std::vector<Manifold>& out);
/// Both boxes (Polyhedron::is_box): what the general routine gives, in a fraction of the time.
void collide_boxes(const Polyhedron& a, const Pose& pose_a, const Polyhedron& b, const Pose& pose_b, double margin,
                   CollisionScratch& scratch, std::vector<Manifold>& out);
void collide_surface_ball(const CollisionMesh& a, const Pose& pose_a, const Ball& b, const Pose& pose_b,
                          double margin, CollisionScratch& scratch, std::vector<Manifold>& out);
void collide_surface_polyhedron(const CollisionMesh& a, const Pose& pose_a, const Polyhedron& b, const Pose& pose_b,
                                double margin, CollisionScratch& scratch, std::vector<Manifold>& out);

}  // namespace tumble
