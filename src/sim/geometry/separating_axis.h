// Which features of two convex polyhedra face each other: the axis of least overlap (or of most separation) among the
// face normals of both and the cross products of their edges (Gottschalk 1996; Gregorius 2013, "The separating axis
// test between convex polyhedra").
#pragma once

#include "sim/geometry/collide.h"

#include <span>

namespace tumble {

struct SeparatingAxis {
    enum class Kind { none, face_a, face_b, edges };   // none: farther apart than the margin
    Kind kind = Kind::none;
    double separation = 0.0;         // m along the axis; negative: overlap
    std::uint32_t feature_a = 0;     // face or edge of A
    std::uint32_t feature_b = 0;
    Vec3 normal = Vec3::Zero();      // away from A, in A's frame
    bool grazed = false;             // a face the shapes slide past; along another axis they are apart
};

/// Which edges are looked at. nearby: those that can be the edges of a contact, and so all that matter when the shapes
/// overlap or are nearer than the margin; shapes farther apart than it may pass for overlapping. all: no such mistake, in
/// the time of all pairs of edges.
enum class EdgeSearch { nearby, all };

/// How far (m) beyond the other shape's bounds edges are looked at, for the best separation known so far. The edges of a
/// contact have points a and b = a + s n with s their separation: a lies within |s| of B, b of A. The best axis so far
/// bounds s from below, the margin from above.
double edge_reach(EdgeSearch search, double margin, double best_separation);

/// `b_in_a` is B's pose in A's frame, and so is the way. given_up: the edges that a face was preferred to (edges_along_face); left as
/// it is where there were none.
SeparatingAxis find_separating_axis(const Polyhedron& a, const Polyhedron& b, const Pose& b_in_a, double margin,
                                    EdgeSearch search, const Vec3& way, CollisionScratch& scratch, SeparatingAxis* given_up = nullptr);

/// How much better (m) an edge pair must separate than a face for being chosen, and B's face than A's, for shapes of this
/// size.
double axis_preference(double smaller_radius, AxisChoice choice = AxisChoice::steady);

/// How much better (m) an edge pair must separate than a face with almost the same normal for being chosen.
double face_over_edges(double smaller_radius);

/// Whether two edges meet so nearly along a face's normal, and separate so little better, that the face says more: its
/// manifold has several points, and the next ones to touch are already among them; of the edges' one point a tilted plate
/// would rattle round. Both as normal and separation; not for AxisChoice::nearest.
bool edges_along_face(const SeparatingAxis& edges, const SeparatingAxis& face, double smaller_radius, AxisChoice choice);

/// Whether that face's manifold, if there is one, has no point where the edges meet: they do so beyond the face's rim. Then
/// the edges speak after all.
bool misses_edges(std::span<const Manifold> of_face, double edges_separation, double smaller_radius);

/// Whether shapes that are `apart` along one axis pass each other along another face: they graze its plane, and what
/// comes nearer would meet nothing but a corner's height of it. Then the face says more: a box that slides from tile to tile
/// does not run into the next tile's side. `face`: separation and normal. Where they graze along both, the way (m) of the step
/// tells which of the two they slide over, if it is longer than what counts as grazing. Not for AxisChoice::nearest.
bool slides_past(const SeparatingAxis& apart, const SeparatingAxis& face, const Vec3& way, double smaller_radius, AxisChoice choice);

/// Whether it can be so for a best axis that separates so far (m): most pairs need not look.
bool may_slide_past(double separation, const Vec3& way, double smaller_radius);

/// Whether a point (body frame) lies in a shape, or no farther than `slack` (m) outside of its planes.
bool contains(const Polyhedron& shape, const Vec3& point, double slack);

}  // namespace tumble
