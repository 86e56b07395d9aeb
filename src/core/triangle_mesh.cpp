#include "core/triangle_mesh.h"

#include <algorithm>
#include <tuple>

namespace tumble {

Bounds TriangleMesh::bounds() const {
    Bounds b;
    for (const Vec3& v : vertices) b.add(v);
    return b;
}

Closedness closedness(const TriangleMesh& mesh) {
    Closedness result;
    struct Use {
        std::uint32_t low, high;  // the edge's vertices
        bool upward;              // used from low to high
        bool operator<(const Use& other) const { return std::tie(low, high) < std::tie(other.low, other.high); }
    };
    std::vector<Use> uses;
    for (const auto& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), a < b});
        }
        // The tetrahedron from the first vertex: sixths of the triple product sum to the volume.
        const Vec3& o = mesh.vertices[0];
        const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
        result.signed_volume += a.dot(b.cross(c)) / 6.0;
    }
    std::sort(uses.begin(), uses.end());
    for (auto edge = uses.begin(); edge != uses.end();) {
        const auto end = std::upper_bound(edge, uses.end(), *edge);
        const auto upward = std::count_if(edge, end, [](const Use& use) { return use.upward; });
        if (2 * upward != end - edge) ++result.unbalanced_edges;
        if (end - edge == 1)
            ++result.open_edges;
        else if (end - edge != 2 || upward != 1)
            ++result.crowded_edges;
        edge = end;
    }
    return result;
}

namespace {

struct Neighbor {
    std::uint32_t triangle = MeshComponents::none;
    bool alike = false;  // true if both use the edge in opposite directions, as consistently wound triangles do
};

/// Neighbors over each edge of each triangle.
std::vector<std::array<Neighbor, 3>> neighbors_of(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    struct Use {
        std::uint32_t low, high, triangle;
        int edge;
        bool upward;
    };
    std::vector<Use> uses;
    uses.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = triangles[t][std::size_t(i)], b = triangles[t][std::size_t((i + 1) % 3)];
            uses.push_back({std::min(a, b), std::max(a, b), t, i, a < b});
        }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
        return std::tie(a.low, a.high, a.triangle, a.edge) < std::tie(b.low, b.high, b.triangle, b.edge);
    });
    std::vector<std::array<Neighbor, 3>> result(triangles.size());
    for (std::size_t first = 0, end = 0; first < uses.size(); first = end) {
        while (end < uses.size() && uses[end].low == uses[first].low && uses[end].high == uses[first].high) ++end;
        if (end - first != 2) continue;
        const Use &a = uses[first], &b = uses[first + 1];
        result[a.triangle][std::size_t(a.edge)] = {b.triangle, a.upward != b.upward};
        result[b.triangle][std::size_t(b.edge)] = {a.triangle, a.upward != b.upward};
    }
    return result;
}

}  // namespace

MeshComponents find_sheets(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const auto neighbors = neighbors_of(triangles);
    MeshComponents result;
    result.sheet.assign(triangles.size(), MeshComponents::none);
    result.flipped.assign(triangles.size(), 0);
    result.rim.assign(triangles.size(), 0);
    std::vector<char> found(triangles.size(), 0);
    std::vector<std::uint32_t> members;
    for (std::uint32_t first = 0; first < triangles.size(); ++first) {
        if (found[first]) continue;
        found[first] = 1;
        members.assign(1, first);
        bool two_sided = true;
        for (std::size_t k = 0; k < members.size(); ++k) {
            const std::uint32_t t = members[k];
            for (const Neighbor& n : neighbors[t]) {
                if (n.triangle == MeshComponents::none) {
                    result.rim[t] = 1;
                    continue;
                }
                const char flipped = char(result.flipped[t] ^ char(!n.alike));
                if (found[n.triangle]) {
                    two_sided = two_sided && result.flipped[n.triangle] == flipped;
                    continue;
                }
                found[n.triangle] = 1;
                result.flipped[n.triangle] = flipped;
                members.push_back(n.triangle);
            }
        }
        for (const std::uint32_t t : members) {
            if (two_sided)
                result.sheet[t] = first;
            else
                result.flipped[t] = 0;
        }
    }
    return result;
}

}  // namespace tumble
