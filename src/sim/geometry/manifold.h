// Contact points of two bodies that touch, or may touch before the end of the step.
#pragma once

#include "core/vector.h"
#include "sim/geometry/body_pair.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace tumble {

struct ContactPoint {
    Vec3 position = Vec3::Zero();  // world, halfway between the two surfaces
    double separation = 0.0;       // m along the normal; negative: overlap
    std::uint64_t feature =
        0;                 // id of the features that meet (vertex and face, edge and edge); the same from step to step
    double impulse = 0.0;  // N s along the normal: of the last step, then of this step
};

/// Predicted gap at a point as the bodies pass each other: the distance of two places, one on each body, or of a place
/// and a straight line, less a constant. A place is a ball's center or a corner; a line is an edge.
struct Curve {
    double distance = 0.0;                          // m, initial distance of the places
    Vec3 straight = Vec3::Zero();                   // world, direction of the line; zero for a place
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  // world, the places on A and on B
};

/// Body whose corners are the points of a manifold; the other body has the face below them. neither: crossing edges,
/// points on balls.
enum class Corners : std::uint8_t { neither, of_a, of_b };

/// Kind of a manifold's single point on a ball: A's or B's ball over the other body's face, or a gap along a Curve.
enum class OnBall : std::uint8_t { no, a_over_face, b_over_face, curve };

/// Up to four points that share a normal. The normal points away from A's surface, towards B (notes section 4).
struct Manifold {
    static constexpr int capacity = 4;  // spans most flat contact areas; a second manifold holds further points

    std::uint32_t a = 0, b = 0;  // body indices
    std::uint32_t part = 0;      // of compounds and meshes: identifies the parts and the triangle that meet, else 0
    std::int16_t count = 0;
    bool more = false;             // those of the same two faces' points that the first manifold has no room for
    bool solved_directly = false;  // whether the direct solver solved it in the last step
    Corners corners = Corners::neither;
    OnBall on_ball = OnBall::no;
    std::uint16_t left_out = 0;  // number of its candidates in CollisionScratch::left_out, for a manifold just found
    std::uint32_t first_left_out = 0;
    Vec3 normal = Vec3::Zero();
    std::array<ContactPoint, capacity> points;

    // Uniform pressure over the area in which the faces meet (contact_area.h): each point's fraction of the load times
    // the number of points, and the mean distance of the area from its centroid over that of the points so loaded.
    std::array<float, capacity> share = {1.0f, 1.0f, 1.0f, 1.0f};
    float spread = 1.0f;

    // Friction acts at one point of the manifold, along `tangent` and `normal x tangent`, and as a torsional moment
    // about the normal. Kept from step to step.
    Vec3 tangent = Vec3::Zero();      // unit, world; zero before the first solve
    double friction[2] = {0.0, 0.0};  // N s on B, along the two tangents
    double twist = 0.0;               // N m s on B, about the normal

    bool has(std::uint64_t feature) const {
        for (int i = 0; i < count; ++i)
            if (points[std::size_t(i)].feature == feature) return true;
        return false;
    }

    /// For a manifold on a ball, which has one point: stored in the place of further points.
    void set_curve(const Curve& c) {
        on_ball = OnBall::curve;
        points[1] = {c.straight, c.distance};
        points[2].position = c.on_a;
        points[3].position = c.on_b;
    }
    Curve curve() const { return {points[1].separation, points[1].position, points[2].position, points[3].position}; }

    /// For crossing edges: their directions (world), stored in the same way. They determine how the normal rotates.
    void set_edges(const Vec3& of_a, const Vec3& of_b) {
        points[1].position = of_a;
        points[2].position = of_b;
    }
    bool of_edges() const { return count == 1 && (points[0].feature >> 62) == 1; }

    /// For B's ball over a face: its center, world, stored in the same way.
    void set_ball(const Vec3& center) {
        on_ball = OnBall::b_over_face;
        points[2].position = center;
    }
    bool ball_over_face() const { return on_ball == OnBall::a_over_face || on_ball == OnBall::b_over_face; }
    const Vec3& ball() const { return points[2].position; }

    /// Exchanges A and B.
    void swap() {
        normal = -normal;
        if (corners != Corners::neither) corners = corners == Corners::of_a ? Corners::of_b : Corners::of_a;
        if (of_edges()) std::swap(points[1].position, points[2].position);
        if (on_ball == OnBall::curve)
            std::swap(points[2].position, points[3].position);
        else if (ball_over_face())
            on_ball = on_ball == OnBall::a_over_face ? OnBall::b_over_face : OnBall::a_over_face;
    }

    /// For a manifold on a face: whether the normal is that of a face of B (feature_contact.cpp).
    bool on_b() const { return (points[0].feature >> 63) != 0; }
};

/// The body pairs of the manifolds, in their order.
std::vector<BodyPair> body_pairs(const std::vector<Manifold>& manifolds);

/// Fills `manifold.points` with the candidates. Of more than four it keeps the deepest and three that span a large area
/// with it, points that touch first. The rest is appended to `left_out`.
void keep_best_points(const std::vector<ContactPoint>& candidates, Manifold& manifold,
                      std::vector<ContactPoint>& left_out);

}  // namespace tumble
