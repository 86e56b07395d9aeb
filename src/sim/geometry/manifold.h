// Contact points of two bodies that touch, or may touch before the end of the step.
#pragma once

#include "core/vector.h"
#include "sim/geometry/body_pair.h"

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

namespace tumble {

struct ContactPoint {
    Vec3 position = Vec3::Zero();  // world, halfway between the two surfaces
    double separation = 0.0;       // m along the normal; negative: overlap
    std::uint64_t feature =
        0;                 // id of the features that meet (vertex and face, edge and edge); the same from step to step
    double impulse = 0.0;  // N s along the normal: of the last step, then of this step
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [position, separation, feature, impulse] = self;
        archive.keep(position, separation, impulse);
        archive.any(feature);
    }
};

/// Body whose corners are the points of a manifold; the other body has the face below them. neither: crossing edges,
/// points on balls.
enum class Corners : std::uint8_t { neither, of_a, of_b };

/// Geometry of a manifold's single point, or of two on a round side, where its gap or its normal changes otherwise than
/// that of corners over a face. All vectors in the world frame.
struct NoCurve {};
/// A ball over the other body's face: the gap is the height of the ball's center, less the radius. A round side on a
/// face has one such ball at each of its two points, centered on its axis.
struct BallOverFace {
    bool ball_of_a = false;
    Vec3 center = Vec3::Zero();
};
/// The gap is the distance of two points, one on each body, or of a point and a line, less a constant. A point is a
/// ball's center or a corner; a line is an edge.
struct CurvedGap {
    double distance = 0.0;                          // m, initial distance of the points
    Vec3 line = Vec3::Zero();                       // direction of the line; zero for two points
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  // the points on A and on B
};
/// The directions of two crossing edges determine how the normal rotates.
struct CrossingEdges {
    Vec3 of_a = Vec3::Zero(), of_b = Vec3::Zero();
};
using PointGeometry = std::variant<NoCurve, BallOverFace, CurvedGap, CrossingEdges>;

/// The same with A and B exchanged.
PointGeometry swapped(const PointGeometry& geometry);

enum class GeometryKind : std::uint8_t { none, ball_of_a, ball_of_b, curved_gap, crossing_edges };

/// How the last step treated a manifold. flight: joined bodies flew, and do not meet on their way.
enum class SolvedBy : std::uint8_t { sweeps, direct, flight };

/// Up to four points that share a normal. The normal points away from A's surface, towards B (notes section 4).
struct Manifold {
    static constexpr int capacity = 4;  // spans most flat contact areas; a second manifold holds further points

    std::uint32_t a = 0, b = 0;  // body indices
    // of compounds and meshes: identifies the parts and the triangle that meet, otherwise 0
    std::uint32_t part = 0;
    std::int16_t count = 0;
    bool more = false;  // those of the same two faces' points that the first manifold has no room for
    SolvedBy solved_by = SolvedBy::sweeps;
    Corners corners = Corners::neither;
    GeometryKind kind = GeometryKind::none;
    std::uint16_t reduced = 0;  // number of its candidates in CollisionScratch::reduced, for a manifold just found
    std::uint32_t first_reduced = 0;
    Vec3 normal = Vec3::Zero();
    std::array<ContactPoint, capacity> points;

    // Uniform pressure over the area in which the faces meet (contact_area.h): each point's fraction of the load times
    // the number of points, and the mean distance of the area from its centroid over that of the points so loaded.
    std::array<float, capacity> share = {1.0f, 1.0f, 1.0f, 1.0f};
    float spread = 1.0f;
    float area = 0.0f;  // m^2; 0: a line or a point

    // Friction acts at one point of the manifold, along `tangent` and `normal x tangent`, and as a torsional moment
    // about the normal. Kept from step to step.
    Vec3 tangent = Vec3::Zero();      // unit, world; zero before the first solve
    double friction[2] = {0.0, 0.0};  // N s on B, along the two tangents
    double torsion = 0.0;             // N m s on B, about the normal
    float rolling[2] = {0.0f, 0.0f};  // N m s on B, rolling friction about both tangents

    /// Geometry of the single point. It is kept in the slots of the points that such a manifold does not have: with a
    /// member of its own a manifold has 376 bytes instead of 288, and heaps take 4 % more time.
    PointGeometry geometry(int point = 0) const;
    void set_geometry(const PointGeometry& geometry);
    /// Center of the ball at the second point. Precondition: the first is a BallOverFace, and there are two points.
    void set_second_ball(const Vec3& center) { points[3].position = center; }
    bool has_curved_gap() const { return kind == GeometryKind::curved_gap; }
    bool has_ball_over_face() const { return kind == GeometryKind::ball_of_a || kind == GeometryKind::ball_of_b; }

    bool has(std::uint64_t feature) const {
        for (int i = 0; i < count; ++i)
            if (points[std::size_t(i)].feature == feature) return true;
        return false;
    }

    /// Exchanges A and B.
    void swap() {
        normal = -normal;
        if (corners != Corners::neither) corners = corners == Corners::of_a ? Corners::of_b : Corners::of_a;
        set_geometry(swapped(geometry()));
    }

    /// For a manifold on a face: whether the normal is that of a face of B (feature_contact.cpp).
    bool on_b() const { return (points[0].feature >> 63) != 0; }
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [a, b, part, count, more, solved_by, corners, kind, reduced, first_reduced, normal, points, share, spread,
               area, tangent, friction, torsion, rolling] = self;
        archive.body(a, b);
        archive.between(0, count, capacity);
        archive.enumeration(corners, Corners::of_b);
        archive.enumeration(solved_by, SolvedBy::flight);
        archive.enumeration(kind, GeometryKind::crossing_edges);
        archive.any(part);
        archive.keep(more, normal, points, share, spread, area, tangent, friction, torsion, rolling);
        archive.scratch(reduced, first_reduced);
    }
};

/// The body pairs of the manifolds, in their order.
std::vector<BodyPair> body_pairs(const std::vector<Manifold>& manifolds);

/// Fills `manifold.points` with the candidates. Of more than four it keeps the deepest and three that span a large area
/// with it, points that touch first. The rest is appended to `reduced`.
void keep_best_points(const std::vector<ContactPoint>& candidates, Manifold& manifold,
                      std::vector<ContactPoint>& reduced);

}  // namespace tumble
