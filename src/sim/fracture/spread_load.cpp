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

struct Patch {
    std::uint32_t cell;
    double area;  // m^2
    Vec3 center;  // m
};

// The face of a cell in the plane of the contact.
std::vector<Patch> patches(const BreakableBody& body, std::uint32_t piece, const Vec3& into, double height) {
    std::vector<Patch> found;
    for (const std::uint32_t cell : body.cells_of(piece)) {
        const Polyhedron& hull = body.hull_of(cell);
        const Vec3& center = body.mass_of(cell).center_of_mass;
        for (const Polyhedron::Face& face : hull.faces) {
            if (face.normal.dot(into) > same_normal - 1.0) continue;
            if (std::abs(face.normal.dot(center) + face.offset + height) > same_plane * hull.radius) continue;
            Vec3 middle = Vec3::Zero(), area = Vec3::Zero();
            const Vec3& first = hull.vertices[face.vertices[0]];
            for (std::size_t i = 1; i + 1 < face.vertices.size(); ++i) {
                const Vec3 &a = hull.vertices[face.vertices[i]], &b = hull.vertices[face.vertices[i + 1]];
                const Vec3 part = (a - first).cross(b - first);
                area += part;
                middle += part.norm() / 3.0 * (first + a + b);
            }
            if (!(area.norm() > 0.0)) continue;
            found.push_back({cell, 0.5 * area.norm(), center + middle / area.norm()});
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
    std::vector<Patch> under = patches(body, piece, into, into.dot(middle));
    std::erase_if(under, [&](const Patch& patch) { return !covered(patch.center, points, into); });
    if (under.size() < 3) return at_points();
    // p = c . (1, x, y): the same force and moments.
    const Vec3 x = into.unitOrthogonal(), y = into.cross(x);
    Mat3 sums = Mat3::Zero();
    Vec3 wanted = Vec3::Zero();
    const auto row = [&](const Vec3& at) { return Vec3(1.0, x.dot(at - middle), y.dot(at - middle)); };
    for (const Patch& patch : under) sums += patch.area * row(patch.center) * row(patch.center).transpose();
    for (const PointForce& p : points) wanted += into.dot(p.force) * row(p.point);
    const Eigen::LDLT<Mat3> solved(sums);
    if (solved.info() != Eigen::Success || !(solved.rcond() > 1e-9)) return at_points();
    const Vec3 pressure = solved.solve(wanted);
    for (const Patch& patch : under)
        if (!(pressure.dot(row(patch.center)) >= 0.0)) return at_points();
    for (const Patch& patch : under)
        forces.push_back({patch.cell, {patch.center, patch.area * pressure.dot(row(patch.center)) * into}});
}

}  // namespace tumble
