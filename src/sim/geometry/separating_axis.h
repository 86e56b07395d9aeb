// The features of two convex polyhedra that face each other: the axis of least overlap (or of most separation) among
// the face normals of both and the cross products of their edges (Gottschalk 1996; Gregorius 2013, "The separating axis
// test between convex polyhedra").
#pragma once

#include "sim/geometry/collide.h"

#include <span>

namespace tumble {

struct SeparatingAxis {
    enum class Kind { none, face_a, face_b, edges };  // none: farther apart than the margin
    Kind kind = Kind::none;
    double separation = 0.0;      // m along the axis; negative: overlap
    std::uint32_t feature_a = 0;  // index of a face or edge of A
    std::uint32_t feature_b = 0;
    Vec3 normal = Vec3::Zero();  // away from A, in A's frame
    bool grazed = false;         // a face that the shapes slide past; they are separated along another axis
};

/// Edges that the search covers. nearby: those that can be the edges of a contact, which is sufficient when the shapes
/// overlap or are nearer than the margin; shapes farther apart may seem to overlap. all: no such mistake, at the cost
/// of all pairs of edges.
enum class EdgeSearch { nearby, all };

/// Distance (m) beyond the other shape's bounds up to which edges are tested, for the best separation known so far. The
/// edges of a contact have points a and b = a + s n with s their separation: a lies within |s| of B, b of A. The best
/// axis so far bounds s from below, the margin from above.
double edge_reach(EdgeSearch search, double margin, double best_separation);

struct AxisQuery {
    const Polyhedron &a, &b;
    const Pose& b_in_a;  // B's pose in A's frame
    double margin;       // m
    EdgeSearch edges;
    Vec3 displacement;  // m, displacement of B relative to A in the coming step, in A's frame
};

/// rejected_edges: the edges that were rejected in favor of a face (edges_along_face); unchanged where there were none.
SeparatingAxis find_separating_axis(const AxisQuery& query, CollisionScratch& scratch,
                                    SeparatingAxis* rejected_edges = nullptr);

/// Separation (m) by which an edge pair must exceed a face to be chosen, and B's face A's, for shapes of this size.
double axis_preference(double smaller_radius, AxisChoice choice = AxisChoice::steady);

/// Separation (m) by which an edge pair must exceed a face with almost the same normal to be chosen.
double face_over_edges(double smaller_radius);

/// True if two edges meet so nearly along a face's normal, and separate so little better, that the face is preferred:
/// its manifold has several points and already includes the next ones to touch, while on the edges' single point a
/// tilted plate would rattle. Both as normal and separation; not for AxisChoice::nearest.
bool edges_along_face(const SeparatingAxis& edges, const SeparatingAxis& face, double smaller_radius,
                      AxisChoice choice);

/// True if the manifold of that face, if there is one, has no point where the edges meet, because they meet beyond the
/// face's border. Then the edges are used after all.
bool misses_edges(std::span<const Manifold> of_face, double edges_separation, double smaller_radius);

/// True if shapes that are `apart` along one axis pass each other along another face: they graze its plane, and the
/// nearer feature would meet only a corner's height of it. Then the face is preferred: a box that slides from tile to
/// tile does not run into the next tile's side. `face`: separation and normal. Where they graze along both, the
/// displacement (m) of the step selects the face that they slide over, if it is longer than the grazing tolerance. Not
/// for AxisChoice::nearest.
bool slides_past(const SeparatingAxis& apart, const SeparatingAxis& face, const Vec3& displacement,
                 double smaller_radius, AxisChoice choice);

/// True if slides_past is possible for a best axis of this separation (m): most pairs are excluded by it.
bool may_slide_past(double separation, const Vec3& displacement, double smaller_radius);

}  // namespace tumble
