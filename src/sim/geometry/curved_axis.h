// The axis of largest separation (or least overlap) of a curved body from another convex shape, to rounding.
//
// Along a unit normal n from A to B the shapes are apart by s(n) = n.(b - a), with b and a the farthest points of B
// along -n and of A along n. Each s(n) is a lower bound of the distance; the largest is the distance itself, or minus
// the depth of an overlap. s has ridges where a shape has more than one farthest point: at the normals of faces and
// discs, and along the arcs of normals of edges and round sides. So the largest lies at a face, at the crossing of two
// arcs, on an arc, or where s is smooth; each candidate is found in closed form or by Newton's method from the axis of
// a search by simplices.
#pragma once

#include "sim/geometry/collide.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble {

/// A shape of a pair in the frame of the search: a curved body, a polyhedron, a triangle or a point; rounded by a
/// radius. Refers to its shape.
struct ConvexShape {
    const CurvedBody* curved = nullptr;
    const Polyhedron* hull = nullptr;
    std::array<Vec3, 3> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    int corner_count = 0;   // 3: a triangle; 1: a point; 0: another shape
    double rounding = 0.0;  // m
    double size = 0.0;      // m, of its farthest point from its center
    Pose pose;
    Vec3 center = Vec3::Zero();  // m, a point inside
    Vec3 facing = Vec3::Zero();  // of a triangle: its normal on the other shape's side

    Vec3 axis() const { return pose.rotation.col(1); }
    /// The farthest point along a direction, without the rounding.
    Vec3 support(const Vec3& direction) const;
    /// u . D v, with D the derivative of that point by the unit direction.
    double bend(const Vec3& direction, const Vec3& u, const Vec3& v) const;
};

ConvexShape convex_shape(const CurvedBody& body, const Pose& pose);
ConvexShape convex_shape(const Polyhedron& hull, const Pose& pose);
/// A ball as a rounded point.
ConvexShape convex_shape(const Ball& ball, const Pose& pose);
ConvexShape convex_triangle(const std::array<Vec3, 3>& corners, const Vec3& facing);

struct CurvedAxis {
    enum class Kind { face_a, face_b, other };
    Kind kind = Kind::other;        // a face of a polyhedron or a triangle, or a disc
    std::uint32_t feature = 0;      // its index; of a disc its end
    Vec3 normal = Vec3::UnitY();    // from A to B
    double separation = -infinity;  // m
};

/// The search for the axes of a pair, in two parts: the faces and discs are often enough. Refers to the shapes.
class CurvedAxisSearch {
public:
    CurvedAxisSearch(const ConvexShape& a, const ConvexShape& b) : a_(a), b_(b) {}

    /// Finds the best faces and discs. False if the shapes are farther apart than `margin` (m); gap() is then a lower
    /// bound of their distance. `guess`: the normal of the last step in either direction, or zero.
    bool find_flat(double margin, const Vec3& guess = Vec3::Zero());
    /// The best face or disc of A, or of B; separation -infinity without one.
    const CurvedAxis& flat(bool of_b) const { return flat_[of_b ? 1 : 0]; }
    /// The axis of the search by simplices: near the best one.
    const Vec3& first() const { return first_; }
    double separation(const Vec3& n) const { return n.dot(between(n)) - a_.rounding - b_.rounding; }
    /// The best of all. Precondition: find_flat() was true.
    const CurvedAxis& find_best();
    double gap() const { return gap_; }

private:
    /// Normals of an arc, at an angle with its axis: n . axis = level. Along them the farthest points are a line: an
    /// edge with these ends, or one of a round side.
    struct Arc {
        Vec3 axis;
        double level;
        bool edge;
        std::array<Vec3, 2> ends;
    };
    struct Line {
        Vec3 from, way;
    };
    /// Faces and edges up to which all of a polyhedron are tried; of larger ones those at the corners near the axis.
    static constexpr std::size_t few_features = 24;

    Vec3 between(const Vec3& n) const { return b_.support(-n) - a_.support(n); }
    double bend(const Vec3& n, const Vec3& u, const Vec3& v) const { return a_.bend(n, u, v) + b_.bend(-n, u, v); }
    bool start(double margin);
    bool start_from(const Vec3& guess);
    void consider(const Vec3& n, CurvedAxis::Kind kind = CurvedAxis::Kind::other, std::uint32_t feature = 0);
    void add_features(const ConvexShape& shape, bool of_b);
    Line line_of(const Arc& arc, const ConvexShape& shape, const Vec3& outward) const;
    bool level_along(const Arc& arc, bool of_b, const Vec3& n) const;
    bool settle();
    bool settle_crossing(const Arc& of_a, const Arc& of_b);
    // True if the result is the largest nearby to rounding: where the shapes are nearest, the line between them is
    // along the axis.
    bool search_smooth();
    void search_all();
    bool search_arc(const Arc& arc, bool of_b);
    std::array<Vec3, 2> crossings(const Arc& one, const Arc& other, int& count) const;

    const ConvexShape &a_, &b_;
    CurvedAxis best_, flat_[2];
    Vec3 first_ = Vec3::UnitY();
    double gap_ = 0.0;
    bool guessed_ = false;  // first_ is the axis of the last step
    std::array<Arc, 2 * few_features> arcs_[2];
    std::size_t arc_count_[2] = {0, 0};
};

}  // namespace tumble
