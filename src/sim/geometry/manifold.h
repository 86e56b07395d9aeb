// Where two bodies touch, or may touch before the step is over.
#pragma once

#include "core/vector.h"
#include "sim/geometry/body_pair.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace tumble {

struct ContactPoint {
    Vec3 position = Vec3::Zero();   // world, halfway between the two surfaces
    double separation = 0.0;        // m along the normal; negative: overlap
    std::uint64_t feature = 0;      // the features that meet (vertex and face, edge and edge); the same from step to step
    double impulse = 0.0;           // N s along the normal: the last step's, then this step's
};

/// How the gap at a point grows as the bodies pass each other: it is that of two places, one on each body, that keep their
/// distance, or of a place and a straight line. A ball's centre and a corner, an edge, another ball's centre.
struct Curve {
    double distance = 0.0;             // m, of the places
    Vec3 straight = Vec3::Zero();      // world: the line's direction; none for a place
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();   // the places, world
};

/// Whose corners a manifold's points are; the other body has the face that they lie over. neither: crossing edges, points on balls.
enum class Corners : std::uint8_t { neither, of_a, of_b };

/// What a manifold's one point is where it is on a ball: A's or B's ball over the other body's face, or a gap along a Curve.
enum class OnBall : std::uint8_t { no, a_over_face, b_over_face, curve };

/// Up to four points that share a normal. The normal points away from A's surface, towards B (notes section 4).
struct Manifold {
    static constexpr int capacity = 4;   // spans most flat contact areas; where more are needed a second manifold has them

    std::uint32_t a = 0, b = 0;   // bodies
    std::uint32_t part = 0;       // of the pair: which parts of compounds and which triangle of a surface meet, else 0
    std::int16_t count = 0;
    bool more = false;            // those of the same two faces' points that the first manifold has no room for
    bool solved_directly = false; // by the direct contact solver, in the last step
    Corners corners = Corners::neither;
    OnBall on_ball = OnBall::no;
    std::uint16_t left_out = 0;   // of a manifold just found: its candidates in CollisionScratch::left_out
    std::uint32_t first_left_out = 0;
    Vec3 normal = Vec3::Zero();
    std::array<ContactPoint, capacity> points;

    // Even pressure over the area in which the faces meet (contact_area.h): each point's part of the load, times how many there are, and
    // the mean distance of the area from its centroid over that of the points so loaded.
    std::array<float, capacity> share = {1.0f, 1.0f, 1.0f, 1.0f};
    float spread = 1.0f;

    // Friction acts at one point of the manifold, along `tangent` and `normal x tangent`, and as a twist about the normal.
    // Carried from step to step.
    Vec3 tangent = Vec3::Zero();          // unit, world; zero before the first solve
    double friction[2] = {0.0, 0.0};      // N s on B
    double twist = 0.0;                   // N m s on B

    bool has(std::uint64_t feature) const {
        for (int i = 0; i < count; ++i)
            if (points[std::size_t(i)].feature == feature) return true;
        return false;
    }

    /// Of one on a ball, which has one point: kept where further ones would be.
    void set_curve(const Curve& c) {
        on_ball = OnBall::curve;
        points[1] = {c.straight, c.distance};
        points[2].position = c.on_a;
        points[3].position = c.on_b;
    }
    Curve curve() const { return {points[1].separation, points[1].position, points[2].position, points[3].position}; }

    /// Of one where edges cross: their directions (world), kept in the same way. They tell how the normal turns.
    void set_edges(const Vec3& of_a, const Vec3& of_b) {
        points[1].position = of_a;
        points[2].position = of_b;
    }
    bool of_edges() const { return count == 1 && (points[0].feature >> 62) == 1; }

    /// The same of B's ball over a face: where its centre is, world.
    void set_ball(const Vec3& center) {
        on_ball = OnBall::b_over_face;
        points[2].position = center;
    }
    bool ball_over_face() const { return on_ball == OnBall::a_over_face || on_ball == OnBall::b_over_face; }
    const Vec3& ball() const { return points[2].position; }

    /// The same, seen from the other body.
    void swap() {
        normal = -normal;
        if (corners != Corners::neither) corners = corners == Corners::of_a ? Corners::of_b : Corners::of_a;
        if (of_edges()) std::swap(points[1].position, points[2].position);
        if (on_ball == OnBall::curve) std::swap(points[2].position, points[3].position);
        else if (ball_over_face()) on_ball = on_ball == OnBall::a_over_face ? OnBall::b_over_face : OnBall::a_over_face;
    }

    /// Of one along a face: whether the normal is that of the second shape's (feature_contact.cpp).
    bool on_b() const { return (points[0].feature >> 63) != 0; }
};

/// Whose the manifolds are, one by one.
std::vector<BodyPair> body_pairs(const std::vector<Manifold>& manifolds);

/// Fills `manifold.points` with the candidates, or, when there are more than four, with the deepest and three that span a
/// large area with it: of those that touch before the others. The rest is appended to `left_out`.
void keep_best_points(const std::vector<ContactPoint>& candidates, Manifold& manifold, std::vector<ContactPoint>& left_out);

}  // namespace tumble
