#include "scene/fracture/bonds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tumble {
namespace {

/// The corners on the inner side of an edge from a to b of a face with this normal.
std::vector<Vec3> trimmed(const std::vector<Vec3>& polygon, const Vec3& a, const Vec3& b, const Vec3& normal,
                          double tolerance) {
    const Vec3 inward = normal.cross(b - a).normalized();
    const auto side = [&](const Vec3& p) {
        const double s = inward.dot(p - a);
        return std::abs(s) <= tolerance ? 0.0 : s;
    };
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double at_p = side(p), at_q = side(q);
        if (at_p >= 0.0) kept.push_back(p);
        if (at_p * at_q < 0.0) kept.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    return kept;
}

std::vector<Vec3> polygon_of(const ConvexCell& cell, const ConvexCell::Face& face) {
    std::vector<Vec3> polygon;
    for (const std::uint32_t v : face.vertices) polygon.push_back(cell.vertices[v]);
    return polygon;
}

/// The bond of two cells, whose convexity allows for one shared face.
std::optional<Bond> bond_between(const ConvexCell& a, const ConvexCell& b, const BondRequest& request) {
    constexpr double opposite = -1.0 + 1e-12;  // cosine of normals: angles up to 1.4e-6
    for (const ConvexCell::Face& of_a : a.faces)
        for (const ConvexCell::Face& of_b : b.faces) {
            if (of_a.normal.dot(of_b.normal) > opposite) continue;
            if (std::abs(of_a.offset + of_b.offset) > request.tolerance) continue;
            std::vector<Vec3> polygon = polygon_of(a, of_a);
            for (std::size_t i = 0; i < of_b.vertices.size() && polygon.size() > 2; ++i)
                polygon =
                    trimmed(polygon, b.vertices[of_b.vertices[i]],
                            b.vertices[of_b.vertices[(i + 1) % of_b.vertices.size()]], of_b.normal, request.tolerance);
            if (auto bond = section_of(polygon, of_a.normal, request.least_area)) return bond;
        }
    return std::nullopt;
}

}  // namespace

std::optional<Bond> section_of(std::span<const Vec3> polygon, const Vec3& normal, double least_area) {
    constexpr double round = 1e-12;  // of the moments: a product of inertia of less is rounding
    if (polygon.size() < 3) return std::nullopt;
    int flattest = 0;
    for (const int i : {1, 2})
        if (std::abs(normal[i]) < std::abs(normal[flattest])) flattest = i;
    const Vec3 u = (Vec3::Unit(flattest) - normal[flattest] * normal).normalized(), v = normal.cross(u);

    double area = 0.0, first_x = 0.0, first_y = 0.0;
    const auto place = [&](std::size_t i, const Vec3& from) {
        const Vec3 p = polygon[i % polygon.size()] - from;
        return std::array{u.dot(p), v.dot(p)};
    };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto [x0, y0] = place(i, polygon[0]);
        const auto [x1, y1] = place(i + 1, polygon[0]);
        const double twice = x0 * y1 - x1 * y0;
        area += twice / 2.0;
        first_x += twice * (x0 + x1) / 6.0;
        first_y += twice * (y0 + y1) / 6.0;
    }
    if (!(area > least_area)) return std::nullopt;

    Bond bond;
    bond.area = area;
    bond.center = polygon[0] + first_x / area * u + first_y / area * v;
    bond.normal = normal;
    double xx = 0.0, yy = 0.0, xy = 0.0;  // m^4, about the center
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto [x0, y0] = place(i, bond.center);
        const auto [x1, y1] = place(i + 1, bond.center);
        const double twice = x0 * y1 - x1 * y0;
        xx += twice * (x0 * x0 + x0 * x1 + x1 * x1) / 12.0;
        yy += twice * (y0 * y0 + y0 * y1 + y1 * y1) / 12.0;
        xy += twice * (x0 * y1 + 2.0 * x0 * y0 + 2.0 * x1 * y1 + x1 * y0) / 24.0;
    }
    bond.axis1 = u;
    bond.axis2 = v;
    if (std::abs(xy) > round * (xx + yy)) {  // one rotation of Jacobi's, as in principal_inertia
        const double theta = (yy - xx) / (2.0 * xy);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        bond.axis1 = c * u - s * v;
        bond.axis2 = s * u + c * v;
        xx -= t * xy;
        yy += t * xy;
    }
    bond.moment1 = yy;
    bond.moment2 = xx;
    double reach1 = 0.0, reach2 = 0.0, reach = 0.0;
    for (const Vec3& p : polygon) {
        const Vec3 r = p - bond.center;
        reach1 = std::max(reach1, std::abs(bond.axis1.dot(r)));
        reach2 = std::max(reach2, std::abs(bond.axis2.dot(r)));
        reach = std::max(reach, r.norm());
    }
    bond.modulus1 = bond.moment1 / reach2;
    bond.modulus2 = bond.moment2 / reach1;
    bond.polar_modulus = (bond.moment1 + bond.moment2) / reach;
    return bond;
}

std::vector<Bond> find_bonds(const BondRequest& request) {
    const std::span<const ConvexCell> cells = request.cells;
    std::vector<Bounds> bounds;
    for (const ConvexCell& cell : cells) bounds.push_back(cell.bounds().grown(request.tolerance));
    std::vector<std::uint32_t> order(cells.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return std::pair(bounds[i].min.x(), i) < std::pair(bounds[j].min.x(), j);
    });
    std::vector<Bond> bonds;
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            if (bounds[order[j]].min.x() > bounds[order[i]].max.x()) break;
            const auto [a, b] = std::minmax(order[i], order[j]);
            if (!bounds[a].overlaps(bounds[b])) continue;
            std::optional<Bond> bond = bond_between(cells[a], cells[b], request);
            if (!bond) continue;
            bond->a = a;
            bond->b = b;
            bond->length = bond->normal.dot(request.centers[b] - request.centers[a]);
            bonds.push_back(*bond);
        }
    std::sort(bonds.begin(), bonds.end(),
              [](const Bond& l, const Bond& r) { return std::pair(l.a, l.b) < std::pair(r.a, r.b); });
    return bonds;
}

void hold_to_world(const BondRequest& request, const Bounds& bounds, const std::array<bool, 6>& held,
                   std::vector<Bond>& bonds) {
    constexpr double same = 1.0 - 1e-12;  // cosine of normals
    for (std::uint32_t a = 0; a < request.cells.size(); ++a)
        for (const ConvexCell::Face& face : request.cells[a].faces)
            for (std::size_t side = 0; side < held.size(); ++side) {
                const int axis = int(side / 2);
                const double sign = side % 2 == 0 ? -1.0 : 1.0;
                const double end = side % 2 == 0 ? -bounds.min[axis] : bounds.max[axis];
                if (!held[side] || !face.outer || sign * face.normal[axis] < same) continue;
                if (std::abs(face.offset - end) > request.tolerance) continue;
                std::optional<Bond> bond =
                    section_of(polygon_of(request.cells[a], face), face.normal, request.least_area);
                if (!bond) continue;
                bond->a = a;
                bond->b = Bond::world;
                bond->length = bond->normal.dot(bond->center - request.centers[a]);
                bonds.push_back(*bond);
            }
    std::stable_sort(bonds.begin(), bonds.end(),
                     [](const Bond& l, const Bond& r) { return std::pair(l.a, l.b) < std::pair(r.a, r.b); });
}

}  // namespace tumble
