// Manifolds of curved bodies. Along the normal each body has a feature: a point, a line of its round side or an edge, a
// disc, a polygon or a plane. The points are those in which the two features, seen along the normal, meet.
//
// Points on the rim of a disc are at angles that stay the same in the body's frame while the disc rests flat: the
// deepest point of a flat disc is rounding, and contact points that followed it would wander.
#pragma once

#include "sim/geometry/curved_axis.h"
#include "sim/geometry/feature_contact.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// The feature of a shape along its outward direction at the contact, in the frame of the search.
struct ContactFeature {
    enum class Kind { point, line, disc, polygon, plane };
    Kind kind = Kind::point;
    Vec3 outward = Vec3::Zero();  // unit: of the contact, out of this shape
    // The ends of a point or a line, and their distances from the axis of the round side, m.
    std::array<Vec3, 2> ends{Vec3::Zero(), Vec3::Zero()};
    std::array<double, 2> bend_radius{0.0, 0.0};
    std::uint32_t label = 0;  // of the corner, the edge or the face
    // A point of the plane of a disc, a polygon or a plane, and its outward normal; the radius of a disc.
    Vec3 origin = Vec3::Zero(), normal = Vec3::Zero();
    double radius = 0.0;
    const ConvexShape* shape = nullptr;  // with a disc
    int end = 0;
    std::vector<ClipVertex>* corners = nullptr;  // of a polygon, counter-clockwise about its normal

    bool flat() const { return kind == Kind::disc || kind == Kind::polygon || kind == Kind::plane; }
    /// The point of the feature's plane on a line along `outward`.
    Vec3 lift(const Vec3& p) const { return p + normal.dot(origin - p) / normal.dot(outward) * outward; }
};

/// The feature along `outward`: points within `level` (m) of the farthest belong to it. Polygons fill `corners`.
ContactFeature feature_along(const ConvexShape& shape, const Vec3& outward, double level,
                             std::vector<ClipVertex>& corners);
/// The face of a polyhedron or a triangle, or the disc, of that index.
ContactFeature face_feature_of(const ConvexShape& shape, std::uint32_t index, const Vec3& outward,
                               std::vector<ClipVertex>& corners);

/// Appends the manifold of two features, if any of its points has a gap below the sink's margin. Sets
/// CollisionScratch::on_ball for points that move over a curved surface.
void add_curved_manifold(const ContactFeature& a, const ContactFeature& b, const Vec3& normal, bool reference_on_b,
                         const ManifoldSink& sink);

}  // namespace tumble
