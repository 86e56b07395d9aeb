#include "sim/ccd/closest_axis.h"

#include <array>
#include <cmath>

namespace tumble {
namespace {

// Up to four points of the Minkowski difference B - A whose hull contains the point nearest to the origin.
struct Simplex {
    std::array<Vec3, 4> points{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    int size = 0;
};

// Each overload keeps only the points that support the nearest point (Ericson 2005, "Real-Time Collision Detection",
// 5.1).
Vec3 nearest(Simplex& s);

Vec3 nearest_on_segment(Simplex& s) {
    const Vec3 a = s.points[0], b = s.points[1], ab = b - a;
    const double t = -a.dot(ab);
    if (t <= 0.0) return s.size = 1, a;
    const double square = ab.squaredNorm();
    if (t >= square) return s.points[0] = b, s.size = 1, b;
    return a + (t / square) * ab;
}

Vec3 nearest_of_edges(Simplex& s) {
    const Simplex triangle = s;
    Vec3 best = Vec3::Zero();
    double distance = infinity;
    for (int i = 0; i < 3; ++i) {
        Simplex edge;
        edge.points[0] = triangle.points[std::size_t(i)];
        edge.points[1] = triangle.points[std::size_t((i + 1) % 3)];
        edge.size = 2;
        const Vec3 p = nearest_on_segment(edge);
        if (p.squaredNorm() >= distance) continue;
        distance = p.squaredNorm();
        best = p;
        s = edge;
    }
    return best;
}

Vec3 nearest_on_triangle(Simplex& s) {
    const Vec3 a = s.points[0], ab = s.points[1] - a, ac = s.points[2] - a, n = ab.cross(ac);
    const double square = n.squaredNorm();
    if (square == 0.0) return nearest_of_edges(s);
    // Barycentric coordinates of the origin's projection.
    const double v = n.dot(ac.cross(a)) / square, w = n.dot(a.cross(ab)) / square;
    if (v < 0.0 || w < 0.0 || v + w > 1.0) return nearest_of_edges(s);
    return (n.dot(a) / square) * n;
}

Vec3 nearest_on_tetrahedron(Simplex& s) {
    const Simplex whole = s;
    Vec3 best = Vec3::Zero();
    double distance = infinity;
    bool inside = true;
    for (std::size_t skip = 0; skip < 4; ++skip) {
        Simplex face;
        for (std::size_t i = 0; i < 4; ++i)
            if (i != skip) face.points[std::size_t(face.size++)] = whole.points[i];
        const Vec3 n = (face.points[1] - face.points[0]).cross(face.points[2] - face.points[0]);
        const double origin = -n.dot(face.points[0]), opposite = n.dot(whole.points[skip] - face.points[0]);
        if (origin * opposite > 0.0) continue;  // the origin is on the inner side of this face
        inside = false;
        const Vec3 p = nearest_on_triangle(face);
        if (p.squaredNorm() >= distance) continue;
        distance = p.squaredNorm();
        best = p;
        s = face;
    }
    return inside ? Vec3(Vec3::Zero()) : best;
}

Vec3 nearest(Simplex& s) {
    switch (s.size) {
        case 1:
            return s.points[0];
        case 2:
            return nearest_on_segment(s);
        case 3:
            return nearest_on_triangle(s);
        default:
            return nearest_on_tetrahedron(s);
    }
}

const Vec3& farthest(const SupportPoints& cloud, const Vec3& direction) {
    const Vec3* best = &cloud.arms[0];
    double most = direction.dot(*best);
    for (const Vec3& arm : cloud.arms) {
        const double d = direction.dot(arm);
        if (d > most) {
            most = d;
            best = &arm;
        }
    }
    return *best;
}

// The arms farthest along a direction, up to three: enough to distinguish a corner, an edge and a face.
struct Feature {
    std::array<Vec3, 3> arms{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    int size = 0;
};

Feature feature_along(const SupportPoints& cloud, const Vec3& direction, double tolerance) {
    const double most = direction.dot(farthest(cloud, direction)) - tolerance;
    Feature feature;
    for (const Vec3& arm : cloud.arms)
        if (direction.dot(arm) >= most && feature.size < 3) feature.arms[std::size_t(feature.size++)] = arm;
    return feature;
}

Vec3 across(const Vec3& v, const Vec3& normal) { return v - normal.dot(v) * normal; }

// n ~ the component of w = q - p across the edge e (unit, rotating at omega): n' = (u' - n (n.u')) / |u|.
Vec3 rate_from_edge(const Vec3& normal, const Vec3& edge, const Vec3& omega, const Vec3& w, const Vec3& w_rate) {
    const Vec3 u = w - w.dot(edge) * edge;
    const double length = u.norm();
    if (length == 0.0) return Vec3::Zero();
    const Vec3 edge_rate = omega.cross(edge);
    const Vec3 u_rate = w_rate - (w_rate.dot(edge) + w.dot(edge_rate)) * edge - w.dot(edge) * edge_rate;
    return across(u_rate, normal) / length;
}

}  // namespace

std::optional<Vec3> closest_vector(const SupportPoints& a, const SupportPoints& b, const Vec3& guess) {
    const Vec3 d = b.center - a.center;
    const double scale = a.reach + b.reach + d.norm();
    Simplex simplex;
    Vec3 v = guess;
    simplex.points[0] = d + farthest(b, -v) - farthest(a, v);
    simplex.size = 1;
    v = simplex.points[0];
    for (int round = 0; round < 64; ++round) {
        const double square = v.squaredNorm();
        if (square <= 1e-28 * scale * scale) return std::nullopt;
        const Vec3 w = d + farthest(b, -v) - farthest(a, v);
        // w is no nearer along v than the present point: converged, to a relative 1e-13.
        if (square - v.dot(w) <= 1e-13 * square) return v;
        for (int i = 0; i < simplex.size; ++i)
            if (simplex.points[std::size_t(i)] == w) return v;
        simplex.points[std::size_t(simplex.size++)] = w;
        const Vec3 next = nearest(simplex);
        if (next.squaredNorm() >= square) return v;  // rounding stops the descent
        v = next;
        if (simplex.size == 4) return std::nullopt;
    }
    return v;
}

Axis tracking_axis(const SupportPoints& a, const SupportPoints& b, const Vec3& normal, double tolerance) {
    const Feature fa = feature_along(a, normal, tolerance), fb = feature_along(b, -normal, tolerance);
    const Vec3 &omega_a = a.angular_velocity, &omega_b = b.angular_velocity;
    if (fa.size >= 3) return {normal, omega_a.cross(normal)};
    if (fb.size >= 3) return {normal, omega_b.cross(normal)};

    const Vec3 d = b.center - a.center, v = b.velocity - a.velocity;
    if (fa.size == 2 && fb.size == 2) {
        const Vec3 ea = (fa.arms[1] - fa.arms[0]).normalized(), eb = (fb.arms[1] - fb.arms[0]).normalized();
        const Vec3 c = ea.cross(eb);
        const double length = c.norm();
        if (length < 1e-6) return {normal, omega_a.cross(normal)};  // parallel edges: any axis that rotates with one
        const Vec3 c_rate = omega_a.cross(ea).cross(eb) + ea.cross(omega_b.cross(eb));
        const double sign = c.dot(normal) < 0.0 ? -1.0 : 1.0;
        return {normal, across(sign / length * c_rate, normal)};
    }
    const Vec3 &p = fa.arms[0], &q = fb.arms[0];
    const Vec3 w = d + q - p, w_rate = v + omega_b.cross(q) - omega_a.cross(p);
    // Two points too close for a direction of the line between them: the axis does not rotate.
    if (w.norm() <= tolerance) return {normal, Vec3::Zero()};
    if (fa.size == 2) return {normal, rate_from_edge(normal, (fa.arms[1] - p).normalized(), omega_a, w, w_rate)};
    if (fb.size == 2) return {normal, rate_from_edge(normal, (fb.arms[1] - q).normalized(), omega_b, w, w_rate)};
    return {normal, across(w_rate, normal) / w.norm()};
}

}  // namespace tumble
