#include "sim/geometry/curved_axis.h"

#include "core/deterministic_math.h"
#include "sim/geometry/nearest_simplex.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Share of the size below which the result of the search by simplices is rounding: the shapes are shrunk for another.
constexpr double simplex_rounding = 1e-7;

/// Overlap (share of the smaller size) up to which the axis of the last step is taken as it is.
constexpr double deep_overlap = 0.05;

/// Cosine of the largest angle between the first axis and the normal of a face or disc that is tried.
constexpr double face_reach = 0.3;

/// Steps of Newton's method: four to six are usual.
constexpr int newton_rounds = 9;

/// Angle (its sine) by which an arc may lie off the first axis.
constexpr double arc_reach = 0.7;

}  // namespace

// Gilbert, Johnson and Keerthi 1988. Of overlapping shapes the result is that of shapes shrunk about their centers.
bool CurvedAxisSearch::start(double margin) {
    const Vec3 d = b_.center - a_.center;
    const double size = a_.size + b_.size, rounding = a_.rounding + b_.rounding;
    for (const double scale : {1.0, 0.99, 0.9, 0.6}) {
        Simplex simplex;
        const auto corner = [&](const Vec3& v) { return Vec3((1.0 - scale) * d + scale * between(v)); };
        Vec3 v = d.squaredNorm() > 0.0 ? d : Vec3::UnitY();
        v = simplex.points[0] = corner(v.normalized());
        simplex.size = 1;
        bool apart = true;
        for (int round = 0; round < 32; ++round) {
            const double square = v.squaredNorm();
            apart = square > simplex_rounding * simplex_rounding * size * size;
            if (!apart) break;
            const Vec3 n = v / std::sqrt(square), w = corner(n);
            if (scale == 1.0 && n.dot(w) - rounding > margin) {
                gap_ = n.dot(w) - rounding;
                return false;
            }
            if (square - v.dot(w) <= 1e-6 * square) break;
            simplex.points[std::size_t(simplex.size++)] = w;
            const Vec3 next = nearest(simplex);
            if (next.squaredNorm() >= square) break;
            v = next;
            apart = simplex.size < 4;
            if (!apart) break;
        }
        if (!apart) continue;
        first_ = v.normalized();
        return true;
    }
    if (d.squaredNorm() > 0.0) first_ = d.normalized();
    return true;
}

void CurvedAxisSearch::consider(const Vec3& n, CurvedAxis::Kind kind, std::uint32_t feature) {
    const double s = separation(n);
    if (s > best_.separation) best_ = {kind, feature, n, s};
    if (kind == CurvedAxis::Kind::other) return;
    CurvedAxis& flat = flat_[kind == CurvedAxis::Kind::face_b ? 1 : 0];
    if (s > flat.separation) flat = {kind, feature, n, s};
}

// Considers the normals of faces and discs, and collects the arcs.
void CurvedAxisSearch::add_features(const ConvexShape& shape, bool of_b) {
    const Vec3& n = first_;
    const double sign = of_b ? -1.0 : 1.0;
    const auto kind = of_b ? CurvedAxis::Kind::face_b : CurvedAxis::Kind::face_a;
    auto& arcs = arcs_[of_b ? 1 : 0];
    std::size_t& count = arc_count_[of_b ? 1 : 0];
    const auto take = [&](const Vec3& normal, std::uint32_t feature) {
        if (normal.dot(n) > face_reach) consider(normal, kind, feature);
    };
    const auto add = [&](const Vec3& axis, double level) {
        if (count < arcs.size() && std::fabs(n.dot(axis) - level) < arc_reach) arcs[count++] = {axis, level};
    };
    if (shape.curved) {
        if (shape.curved->ellipsoid) return;
        for (const int end : {0, 1})
            if (shape.curved->has_disc(end)) take(sign * (end == 0 ? -1.0 : 1.0) * shape.axis(), std::uint32_t(end));
        add(shape.axis(), sign * shape.curved->slant.y());
    } else if (shape.hull) {
        const Polyhedron& hull = *shape.hull;
        const auto out = [&](const Vec3& v) { return Vec3(shape.pose.rotation * v); };
        const std::uint32_t corner = hull.support(shape.pose.rotation.transpose() * (sign * n));
        const auto near = [&](std::uint32_t v) {
            if (v == corner) return true;
            const auto first = hull.neighbors.begin() + hull.first_neighbor[corner];
            const auto last = hull.neighbors.begin() + hull.first_neighbor[corner + 1];
            return std::find(first, last, v) != last;
        };
        const bool few_faces = hull.faces.size() <= few_features, few_edges = hull.edges.size() <= few_features;
        for (std::uint32_t f = 0; f < hull.faces.size(); ++f) {
            const auto& loop = hull.faces[f].vertices;
            if (few_faces || std::any_of(loop.begin(), loop.end(), near)) take(sign * out(hull.faces[f].normal), f);
        }
        for (const Polyhedron::Edge& e : hull.edges)
            if (few_edges || e.tail == corner || e.head == corner)
                add(out(hull.vertices[e.head] - hull.vertices[e.tail]).normalized(), 0.0);
    } else if (shape.corner_count == 3) {
        consider(sign * shape.facing, kind, 0);
        for (std::size_t i = 0; i < 3; ++i) add((shape.corners[(i + 1) % 3] - shape.corners[i]).normalized(), 0.0);
    }
}

// Newton's method on the sphere: with the distance vector w and D = bend of both, (D + n.w) step = the part of w across
// n.
void CurvedAxisSearch::search_smooth() {
    Vec3 n = first_;
    double best = separation(n);
    for (int round = 0; round < newton_rounds; ++round) {
        const Vec3 w = between(n);
        const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
        const double along = n.dot(w), gu = u.dot(w), gv = v.dot(w), uv = bend(n, u, v);
        double uu = bend(n, u, u) + along, vv = bend(n, v, v) + along;
        const double least = 0.5 * (uu + vv) - std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
        const double floor = 1e-3 * (a_.size + b_.size);
        if (!(least > 0.0)) uu += floor - least, vv += floor - least;
        const double determinant = uu * vv - uv * uv;
        if (!(determinant > 0.0)) break;
        Vec3 step = ((vv * gu - uv * gv) * u + (uu * gv - uv * gu) * v) / determinant;
        const double length = step.norm();
        if (length > 0.5) step *= 0.5 / length;
        bool better = false;
        for (int half = 0; half < 3 && !better; ++half, step *= 0.25) {
            const Vec3 next = (n + step).normalized();
            const double s = separation(next);
            better = s > best || length < 1e-7;
            if (!better) continue;
            n = next;
            best = s;
        }
        if (!better || length < 1e-14) break;
    }
    consider(n);
}

// The same along an arc, whose angle is the only unknown.
void CurvedAxisSearch::search_arc(const Arc& arc) {
    const Vec3 base = arc.level * arc.axis;
    const double radius = std::sqrt(std::max(0.0, 1.0 - arc.level * arc.level));
    Vec3 out = first_ - first_.dot(arc.axis) * arc.axis;
    if (!(out.squaredNorm() > 1e-12)) out = arc.axis.unitOrthogonal();
    Vec3 u = out.normalized();
    double best = separation(base + radius * u);
    for (int round = 0; round < newton_rounds; ++round) {
        const Vec3 n = base + radius * u, t = radius * arc.axis.cross(u), w = between(n);
        const double slope = w.dot(t), curve = radius * w.dot(u) + bend(n, t, t);
        double step = curve > 0.0 ? slope / curve : std::copysign(0.3, slope);
        step = std::clamp(step, -0.5, 0.5);
        const double length = std::fabs(step);
        bool better = false;
        for (int half = 0; half < 3 && !better; ++half, step *= 0.25) {
            const Vec3 next = (u + step * arc.axis.cross(u)).normalized();
            const double s = separation(base + radius * next);
            better = s > best || length < 1e-7;
            if (!better) continue;
            u = next;
            best = s;
        }
        if (!better || length < 1e-14) break;
    }
    consider((base + radius * u).normalized());
}

void CurvedAxisSearch::search_crossing(const Arc& one, const Arc& other) {
    const double cosine = one.axis.dot(other.axis);
    const Vec3 cross = one.axis.cross(other.axis);
    const double square = cross.squaredNorm();
    if (square < 1e-12) return;
    const double x = (one.level - cosine * other.level) / square, y = (other.level - cosine * one.level) / square;
    const double rest = 1.0 - x * one.level - y * other.level;
    if (rest < 0.0) return;
    const Vec3 in_plane = x * one.axis + y * other.axis, across = std::sqrt(rest / square) * cross;
    consider((in_plane + across).normalized());
    consider((in_plane - across).normalized());
}

// True if a guess is as good as the result of a search: the shapes overlap little along it, or not at all.
bool CurvedAxisSearch::start_from(const Vec3& guess) {
    if (guess.isZero(0.0)) return false;
    const double ahead = separation(guess), back = separation(-guess);
    first_ = ahead >= back ? guess : Vec3(-guess);
    gap_ = std::max(ahead, back);
    return gap_ > -deep_overlap * std::min(a_.size, b_.size);
}

bool CurvedAxisSearch::find_flat(double margin, const Vec3& guess) {
    if (start_from(guess)) {
        if (gap_ > margin) return false;
    } else if (!start(margin)) {
        return false;
    }
    add_features(a_, false);
    add_features(b_, true);
    gap_ = best_.separation;
    return best_.separation <= margin;
}

const CurvedAxis& CurvedAxisSearch::find_best() {
    search_smooth();
    for (int i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < arc_count_[i]; ++k) search_arc(arcs_[i][k]);
    for (std::size_t i = 0; i < arc_count_[0]; ++i)
        for (std::size_t k = 0; k < arc_count_[1]; ++k) search_crossing(arcs_[0][i], arcs_[1][k]);
    gap_ = best_.separation;
    return best_;
}

Vec3 ConvexShape::support(const Vec3& d) const {
    if (curved) return pose.to_world(curved->support(pose.rotation.transpose() * d));
    if (hull) return pose.to_world(hull->vertices[hull->support(pose.rotation.transpose() * d)]);
    std::size_t best = 0;
    for (std::size_t i = 1; i < std::size_t(corner_count); ++i)
        if (d.dot(corners[i] - corners[best]) > 0.0) best = i;
    return corners[best];
}

double ConvexShape::bend(const Vec3& d, const Vec3& u, const Vec3& v) const {
    if (!curved) return 0.0;
    const Mat3 back = pose.rotation.transpose();
    return (back * u).dot(curved->bend(back * d) * (back * v));
}

ConvexShape convex_shape(const CurvedBody& body, const Pose& pose) {
    ConvexShape shape;
    shape.curved = &body;
    shape.rounding = body.rounding;
    shape.size = body.radius;
    shape.pose = pose;
    shape.center = pose.position;
    return shape;
}

ConvexShape convex_shape(const Polyhedron& hull, const Pose& pose) {
    ConvexShape shape;
    shape.hull = &hull;
    shape.size = hull.radius;
    shape.pose = pose;
    shape.center = pose.position;
    return shape;
}

ConvexShape convex_shape(const Ball& ball, const Pose& pose) {
    ConvexShape shape;
    shape.corners[0] = shape.center = pose.position;
    shape.corner_count = 1;
    shape.rounding = shape.size = ball.radius;
    return shape;
}

ConvexShape convex_triangle(const std::array<Vec3, 3>& corners, const Vec3& facing) {
    ConvexShape shape;
    shape.facing = facing;
    shape.corners = corners;
    shape.corner_count = 3;
    shape.center = (corners[0] + corners[1] + corners[2]) / 3.0;
    for (const Vec3& corner : corners) shape.size = std::max(shape.size, (corner - shape.center).norm());
    return shape;
}

}  // namespace tumble
