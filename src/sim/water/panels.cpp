#include "sim/water/panels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tumble {
namespace {

using Indices = std::array<std::uint32_t, 3>;

class Division {
public:
    Division(std::vector<Vec3>& points, double edge) : points_(points), edge_(edge) {}

    /// True if a triangle was divided.
    bool halve(std::vector<Indices>& triangles) {
        std::vector<Indices> next;
        for (const Indices& t : triangles) divide(t, next);
        const bool more = next.size() > triangles.size();
        triangles = std::move(next);
        return more;
    }

    std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
        const auto [found, fresh] = middles_.try_emplace(std::minmax(a, b), std::uint32_t(points_.size()));
        if (fresh) points_.push_back(0.5 * (points_[std::min(a, b)] + points_[std::max(a, b)]));
        return found->second;
    }

private:
    bool is_long(std::uint32_t a, std::uint32_t b) const { return (points_[a] - points_[b]).norm() > edge_; }

    // An edge is halved by its own length alone, on both of its sides.
    void divide(const Indices& t, std::vector<Indices>& next) {
        std::array<bool, 3> cut;
        for (std::size_t k = 0; k < 3; ++k) cut[k] = is_long(t[k], t[(k + 1) % 3]);
        const auto cuts = std::count(cut.begin(), cut.end(), true);
        if (cuts == 0) return next.push_back(t);
        if (cuts == 3) {
            const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
            for (const Indices& part :
                 {Indices{t[0], ab, ca}, Indices{ab, t[1], bc}, Indices{ca, bc, t[2]}, Indices{ab, bc, ca}})
                next.push_back(part);
            return;
        }
        // From the corner a on: of one cut, it is in the edge from a to b; of two, in all edges but that from c to a.
        std::size_t first = 0;
        while (cuts == 1 ? !cut[first] : cut[(first + 2) % 3]) ++first;
        const std::uint32_t a = t[first], b = t[(first + 1) % 3], c = t[(first + 2) % 3], ab = middle(a, b);
        if (cuts == 1) {
            next.push_back({a, ab, c});
            next.push_back({ab, b, c});
            return;
        }
        const std::uint32_t bc = middle(b, c);
        next.push_back({ab, b, bc});
        next.push_back({a, ab, bc});
        next.push_back({a, bc, c});
    }

    std::vector<Vec3>& points_;
    double edge_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

Vec3 area_of(const std::vector<Vec3>& points, const Indices& t) {
    return 0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
}

}  // namespace

Panels divided(HullPart part, double edge, std::size_t most) {
    Panels made;
    std::vector<Indices> triangles = std::exchange(part.triangles, {});
    made.nodes = std::exchange(part.vertices, {});
    made.part = std::move(part);
    // Halved edges are between half of the limit and all of it: panels have at least an eighth of its square.
    double area = 0.0;
    for (const Indices& t : triangles) area += area_of(made.nodes, t).norm();
    if (triangles.size() < most)
        edge = std::max(edge, std::sqrt(8.0 * area / double(most - triangles.size())));
    else
        edge = infinity;
    Division division(made.nodes, edge);
    while (division.halve(triangles)) {
    }
    for (const Indices& t : triangles) {
        const Vec3 normal = area_of(made.nodes, t);
        if (!(normal.squaredNorm() > 0.0)) continue;
        HullPanel panel{{t[0], t[1], t[2], 0, 0, 0}, normal};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            panel.nodes[3 + k] = division.middle(a, b);
            made.longest = std::max(made.longest, (made.nodes[a] - made.nodes[b]).norm());
        }
        made.panels.push_back(panel);
    }
    return made;
}

}  // namespace tumble
