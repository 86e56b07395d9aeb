#include "sim/fracture/spread_load.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// A face takes part if its normal is that of the contact up to this (1 minus cosine), and lies in its plane up to this
/// share of the piece's cell. Not fitted: far above the clearance of pieces, far below the angles between faces.
constexpr double same_normal = 1e-4;
constexpr double same_plane = 0.02;

/// A face in the plane of the contact.
struct Patch {
    std::uint32_t cell;
    Vec3 center;   // m
    Mat3 moments;  // integral of (1, x, y) (1, x, y)^T, with coordinates in the plane; m^2 to m^4
};

/// Coordinates in the plane of a contact.
struct ContactPlane {
    Vec3 origin, x, y;

    Vec3 row(const Vec3& at) const { return {1.0, x.dot(at - origin), y.dot(at - origin)}; }
};

// The faces of cells in the plane.
std::vector<Patch> patches(const BreakableBody& body, std::uint32_t piece, const Vec3& into,
                           const ContactPlane& plane) {
    std::vector<Patch> found;
    const double height = into.dot(plane.origin);
    for (const std::uint32_t cell : body.cells_of(piece)) {
        const Polyhedron& hull = body.hull_of(cell);
        const Vec3& center = body.mass_of(cell).center_of_mass;
        for (const Polyhedron::Face& face : hull.faces) {
            if (face.normal.dot(into) > same_normal - 1.0) continue;
            if (std::abs(face.normal.dot(center) + face.offset + height) > same_plane * hull.radius) continue;
            Patch patch{cell, Vec3::Zero(), Mat3::Zero()};
            const auto corner = [&](std::size_t i) { return Vec3(center + hull.vertices[face.vertices[i]]); };
            for (std::size_t i = 1; i + 1 < face.vertices.size(); ++i) {
                const Vec3 a = corner(0), b = corner(i), c = corner(i + 1);
                const double area = 0.5 * (b - a).cross(c - a).norm();
                const Vec3 of_a = plane.row(a), of_b = plane.row(b), of_c = plane.row(c), sum = of_a + of_b + of_c;
                // Over a triangle, of linear functions: A/12 (sum of squares + square of the sum).
                patch.moments += area / 12.0 *
                                 (of_a * of_a.transpose() + of_b * of_b.transpose() + of_c * of_c.transpose() +
                                  sum * sum.transpose());
                patch.center += area / 3.0 * (a + b + c);
            }
            if (!(patch.moments(0, 0) > 0.0)) continue;
            patch.center /= patch.moments(0, 0);
            found.push_back(patch);
        }
    }
    return found;
}

// True if a point lies in the convex hull of the points, seen along `normal`.
bool covered(const Vec3& p, std::span<const PointForce> points, const Vec3& normal) {
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < points.size(); ++k) {
            // An edge of the hull has all points on one side.
            const Vec3 out = (points[k].point - points[i].point).cross(normal);
            if (!(out.norm() > 0.0)) continue;
            const auto beyond = [&](const Vec3& q) { return out.dot(q - points[i].point) > 1e-9 * out.norm(); };
            if (std::none_of(points.begin(), points.end(), [&](const PointForce& q) { return beyond(q.point); }) &&
                beyond(p))
                return false;
        }
    return true;
}

}  // namespace

void spread_load(const BreakableBody& body, std::uint32_t piece, const Vec3& into, std::span<const PointForce> points,
                 std::vector<CellForce>& forces) {
    const auto at_points = [&] {
        for (const PointForce& p : points) forces.push_back({body.cell_at(piece, p.point), p});
    };
    if (points.size() < 3) return at_points();
    Vec3 middle = Vec3::Zero();
    for (const PointForce& p : points) middle += p.point / double(points.size());
    ContactPlane plane{middle, into.unitOrthogonal(), Vec3::Zero()};
    plane.y = into.cross(plane.x);
    std::vector<Patch> under = patches(body, piece, into, plane);
    std::erase_if(under, [&](const Patch& patch) { return !covered(patch.center, points, into); });
    // A pressure p = c . (1, x, y) with the same force and moments.
    Mat3 sums = Mat3::Zero();
    Vec3 wanted = Vec3::Zero();
    for (const Patch& patch : under) sums += patch.moments;
    for (const PointForce& p : points) wanted += into.dot(p.force) * plane.row(p.point);
    const Eigen::LDLT<Mat3> solved(sums);
    if (under.empty() || solved.info() != Eigen::Success || !(solved.rcond() > 1e-9)) return at_points();
    const Vec3 pressure = solved.solve(wanted);
    std::vector<Vec3> loads;  // force and its moments, by patch
    for (const Patch& patch : under) {
        loads.push_back(patch.moments * pressure);
        if (!(loads.back()[0] >= 0.0)) return at_points();
    }
    for (std::size_t i = 0; i < under.size(); ++i) {
        const Vec3& load = loads[i];
        if (!(load[0] > 0.0)) continue;
        const Vec3 point = plane.origin + load[1] / load[0] * plane.x + load[2] / load[0] * plane.y;
        forces.push_back({under[i].cell, {point, load[0] * into}});
    }
}

}  // namespace tumble
