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

/// The same of arcs that the axis of the last step counts as lying on, and the cosine of the largest turn of the axis
/// since then. Not fitted: bodies turn by less in a step.
constexpr double near_arc = 0.02;
constexpr double settled_turn = 0.99;

/// Parting of the nearest points across the axis, as a share of the size, that is rounding.
constexpr double axis_rounding = 1e-13;

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
    const auto add = [&](const Arc& arc) {
        if (count < arcs.size() && std::fabs(n.dot(arc.axis) - arc.level) < arc_reach) arcs[count++] = arc;
    };
    const auto add_edge = [&](const Vec3& tail, const Vec3& head) {
        add({(head - tail).normalized(), 0.0, true, {tail, head}});
    };
    if (shape.curved) {
        if (shape.curved->ellipsoid) return;
        for (const int end : {0, 1})
            if (shape.curved->has_disc(end)) take(sign * (end == 0 ? -1.0 : 1.0) * shape.axis(), std::uint32_t(end));
        add({shape.axis(), sign * shape.curved->slant.y(), false, {Vec3::Zero(), Vec3::Zero()}});
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
                add_edge(shape.pose.to_world(hull.vertices[e.tail]), shape.pose.to_world(hull.vertices[e.head]));
    } else if (shape.corner_count == 3) {
        consider(sign * shape.facing, kind, 0);
        for (std::size_t i = 0; i < 3; ++i) add_edge(shape.corners[i], shape.corners[(i + 1) % 3]);
    }
}

// Newton's method on the sphere: with the distance vector w and D = bend of both, (D + n.w) step = the part of w across
// n.
bool CurvedAxisSearch::search_smooth() {
    Vec3 n = first_;
    double best = separation(n);
    bool settled = false;
    const double size = a_.size + b_.size;
    for (int round = 0; round < newton_rounds; ++round) {
        const Vec3 w = between(n);
        const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
        const double along = n.dot(w), gu = u.dot(w), gv = v.dot(w), uv = bend(n, u, v);
        double uu = bend(n, u, u) + along, vv = bend(n, v, v) + along;
        settled = gu * gu + gv * gv <= axis_rounding * axis_rounding * size * size;
        const double least = 0.5 * (uu + vv) - std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
        const double floor = 1e-3 * size;
        settled = settled && least > 0.0;
        if (settled) break;
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
    return settled;
}

// The line of an arc's farthest points along an outward normal of the arc.
CurvedAxisSearch::Line CurvedAxisSearch::line_of(const Arc& arc, const ConvexShape& shape, const Vec3& outward) const {
    if (arc.edge) return {arc.ends[0], arc.ends[1] - arc.ends[0]};
    const Vec3 d = shape.pose.rotation.transpose() * outward;
    const Vec3 first = shape.curved->rim_point(0, d), second = shape.curved->rim_point(1, d);
    return {shape.pose.to_world(first), shape.pose.rotation * (second - first)};
}

// The same along an arc, whose angle is the only unknown.
bool CurvedAxisSearch::search_arc(const Arc& arc, bool of_b) {
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
    const Vec3 n = (base + radius * u).normalized();
    consider(n);
    return level_along(arc, of_b, n);
}

// True if the other shape's point lies over the line of the arc.
bool CurvedAxisSearch::level_along(const Arc& arc, bool of_b, const Vec3& n) const {
    const ConvexShape &own = of_b ? b_ : a_, &other = of_b ? a_ : b_;
    const Vec3 out = of_b ? Vec3(-n) : n, point = other.support(-out);
    const Line line = line_of(arc, own, out);
    const double size = a_.size + b_.size, rounding = axis_rounding * size;
    if (std::fabs(out.dot(line.from - own.support(out))) > rounding) return false;
    const Vec3 across = n.cross(line.way);
    if (std::fabs(across.dot(point - line.from)) > rounding * across.norm()) return false;
    const double along = line.way.dot(point - line.from);
    return along >= 0.0 && along <= line.way.squaredNorm();
}

bool CurvedAxisSearch::settle_crossing(const Arc& of_a, const Arc& of_b) {
    int count = 0;
    for (const Vec3& n : crossings(of_a, of_b, count)) {
        if (count-- <= 0 || !(n.dot(first_) > settled_turn)) continue;
        const Line one = line_of(of_a, a_, n), other = line_of(of_b, b_, -n);
        const double rounding = axis_rounding * (a_.size + b_.size);
        if (std::fabs(n.dot(one.from - a_.support(n))) > rounding ||
            std::fabs(n.dot(other.from - b_.support(-n))) > rounding)
            continue;
        // one.from + s one.way and other.from + t other.way lie on a line along n.
        const Vec3 apart = other.from - one.from, u = n.cross(one.way), v = n.cross(other.way);
        const double s = v.dot(apart) / v.dot(one.way), t = -u.dot(apart) / u.dot(other.way);
        if (!(s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)) continue;
        consider(n);
        return true;
    }
    return false;
}

// True if the kind of candidate nearest to the first axis gives the best axis.
bool CurvedAxisSearch::settle() {
    if (!guessed_) return false;
    const Arc* near[2] = {nullptr, nullptr};
    for (int i = 0; i < 2; ++i) {
        double least = near_arc;
        for (std::size_t k = 0; k < arc_count_[i]; ++k) {
            const double off = std::fabs(first_.dot(arcs_[i][k].axis) - arcs_[i][k].level);
            if (off >= least) continue;
            least = off;
            near[i] = &arcs_[i][k];
        }
    }
    if (near[0] && near[1] && settle_crossing(*near[0], *near[1])) return true;
    for (int i = 0; i < 2; ++i)
        if (near[i] && search_arc(*near[i], i == 1)) return true;
    return !near[0] && !near[1] && search_smooth();
}

std::array<Vec3, 2> CurvedAxisSearch::crossings(const Arc& one, const Arc& other, int& count) const {
    const double cosine = one.axis.dot(other.axis);
    const Vec3 cross = one.axis.cross(other.axis);
    const double square = cross.squaredNorm();
    count = 0;
    if (square < 1e-12) return {Vec3::Zero(), Vec3::Zero()};
    const double x = (one.level - cosine * other.level) / square, y = (other.level - cosine * one.level) / square;
    const double rest = 1.0 - x * one.level - y * other.level;
    if (rest < 0.0) return {Vec3::Zero(), Vec3::Zero()};
    const Vec3 in_plane = x * one.axis + y * other.axis, across = std::sqrt(rest / square) * cross;
    count = 2;
    return {(in_plane + across).normalized(), (in_plane - across).normalized()};
}

// True if a guess is as good as the result of a search: the shapes overlap little along it, or not at all.
bool CurvedAxisSearch::start_from(const Vec3& guess) {
    if (guess.isZero(0.0)) return false;
    const double ahead = separation(guess), back = separation(-guess);
    first_ = ahead >= back ? guess : Vec3(-guess);
    gap_ = std::max(ahead, back);
    return guessed_ = gap_ > -deep_overlap * std::min(a_.size, b_.size);
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

void CurvedAxisSearch::search_all() {
    search_smooth();
    for (int i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < arc_count_[i]; ++k) search_arc(arcs_[i][k], i == 1);
    for (std::size_t i = 0; i < arc_count_[0]; ++i)
        for (std::size_t k = 0; k < arc_count_[1]; ++k) {
            int count = 0;
            for (const Vec3& n : crossings(arcs_[0][i], arcs_[1][k], count))
                if (count-- > 0) consider(n);
        }
}

// The axis of the last step may lie beyond a ridge, at which Newton's method stops.
const CurvedAxis& CurvedAxisSearch::find_best() {
    if (!settle()) {
        search_all();
        if (guessed_ && start(infinity)) {
            arc_count_[0] = arc_count_[1] = 0;
            add_features(a_, false);
            add_features(b_, true);
            search_all();
        }
    }
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
