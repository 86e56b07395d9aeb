#include "sim/geometry/mesh_sidedness.h"

#include "core/deterministic_math.h"
#include "sim/geometry/shapes/mesh.h"

#include <algorithm>
#include <functional>

namespace tumble {
namespace {

using Triangle = CollisionMesh::Triangle;
constexpr std::uint32_t no_triangle = CollisionMesh::none;

NearestOnTriangle nearest(const CollisionMesh& s, std::uint32_t t, const Vec3& point) {
    return nearest_on_triangle(point, s.corner(t, 0), s.corner(t, 1), s.corner(t, 2));
}

bool plane_behind(const CollisionMesh& s, std::uint32_t t, const Vec3& point) {
    return s.triangles[t].normal.dot(point - s.corner(t, 0)) < 0.0;
}

std::span<const std::uint32_t> fan_of(const CollisionMesh& s, std::uint32_t vertex) {
    return std::span(s.fan).subspan(s.fan_start[vertex], s.fan_start[vertex + 1] - s.fan_start[vertex]);
}

// The normals of the component's triangles at a vertex, weighted by their angles there; none on the border.
std::optional<Vec3> vertex_normal(const CollisionMesh& s, std::uint32_t vertex, std::uint32_t sheet) {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t t : fan_of(s, vertex)) {
        const Triangle& triangle = s.triangles[t];
        if (triangle.sheet != sheet) continue;
        const auto i = std::size_t(std::find(triangle.vertices.begin(), triangle.vertices.end(), vertex) -
                                   triangle.vertices.begin());
        const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
        if (triangle.across[i] < 0 || triangle.across[last] < 0) return std::nullopt;
        const Vec3 u = s.vertices[triangle.vertices[next]] - s.vertices[vertex];
        const Vec3 v = s.vertices[triangle.vertices[last]] - s.vertices[vertex];
        sum += atan2_stable(u.cross(v).norm(), u.dot(v)) * triangle.normal;
    }
    return sum;
}

// The mesh's normal at a feature (NearestOnTriangle::feature) of a triangle; none on the border.
std::optional<Vec3> normal_at(const CollisionMesh& s, std::uint32_t t, int feature) {
    const Triangle& triangle = s.triangles[t];
    if (feature == 0) return triangle.normal;
    if (feature >= 4) return vertex_normal(s, triangle.vertices[std::size_t(feature - 4)], triangle.sheet);
    const auto i = std::size_t(feature - 1);
    if (triangle.across[i] < 0) return std::nullopt;
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t other : fan_of(s, triangle.vertices[i])) {
        const auto& edges = s.triangles[other].edge;
        if (std::find(edges.begin(), edges.end(), triangle.edge[i]) != edges.end()) sum += s.triangles[other].normal;
    }
    return sum;
}

// Walks from a triangle over its neighbors to the point of its component that is nearest to the point; another fold of
// the component may be nearer, but is not reached. Returns whether the point is behind it there; none where that is the
// border.
std::optional<bool> sheet_behind(const CollisionMesh& s, std::uint32_t t, const Vec3& point) {
    NearestOnTriangle best = nearest(s, t, point);
    double square = (point - best.point).squaredNorm();
    for (bool nearer = true; nearer;) {
        nearer = false;
        const Triangle from = s.triangles[t];
        for (const std::uint32_t vertex : from.vertices) {
            for (const std::uint32_t other : fan_of(s, vertex)) {
                if (s.triangles[other].sheet != from.sheet) continue;
                const NearestOnTriangle there = nearest(s, other, point);
                const double other_square = (point - there.point).squaredNorm();
                if (other_square >= square) continue;
                best = there;
                square = other_square;
                t = other;
                nearer = true;
            }
        }
    }
    const auto normal = normal_at(s, t, best.feature);
    if (!normal) return std::nullopt;
    return normal->dot(point - best.point) < 0.0;
}

// Fills `piece` with the connected pieces among the given triangles.
void find_pieces(const CollisionMesh& s, std::span<const std::uint32_t> triangles, SideScratch& scratch) {
    scratch.joined.reset(triangles.size());
    scratch.at_edges.clear();
    for (std::uint32_t k = 0; k < triangles.size(); ++k)
        for (const std::uint32_t edge : s.triangles[triangles[k]].edge) scratch.at_edges.emplace_back(edge, k);
    std::sort(scratch.at_edges.begin(), scratch.at_edges.end());
    for (std::size_t i = 1; i < scratch.at_edges.size(); ++i) {
        const auto [edge, k] = scratch.at_edges[i - 1];
        const auto [other_edge, other] = scratch.at_edges[i];
        if (edge != other_edge || s.triangles[triangles[k]].sheet != s.triangles[triangles[other]].sheet) continue;
        scratch.joined.join(k, other);
    }
    scratch.piece.resize(triangles.size());
    for (std::uint32_t k = 0; k < triangles.size(); ++k) scratch.piece[k] = std::uint32_t(scratch.joined.root(k));
}

}  // namespace

void find_sides(const CollisionMesh& mesh, std::span<const std::uint32_t> triangles, const Vec3& point,
                SideScratch& scratch) {
    auto& behind = scratch.behind;
    behind.clear();
    for (const std::uint32_t t : triangles) behind.push_back(plane_behind(mesh, t, point));
    // The triangle of the nearest point is among them and right: if all agree, all are right. Most searches end here.
    const bool mixed = std::adjacent_find(behind.begin(), behind.end(), std::not_equal_to{}) != behind.end();
    if (!mixed || mesh.closed) return;
    find_pieces(mesh, triangles, scratch);
    const auto& piece = scratch.piece;
    auto& pieces = scratch.pieces;
    pieces.assign(triangles.size(), {});
    for (std::size_t k = 0; k < triangles.size(); ++k)
        pieces[piece[k]].mixed = pieces[piece[k]].mixed || behind[k] != behind[piece[k]];
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        SideScratch::Piece& whole = pieces[piece[k]];
        if (!whole.mixed) continue;
        const double square = (point - nearest(mesh, triangles[k], point).point).squaredNorm();
        if (whole.nearest != no_triangle && square >= whole.square) continue;
        whole.square = square;
        whole.nearest = triangles[k];
    }
    for (SideScratch::Piece& whole : pieces)
        if (whole.mixed && mesh.triangles[whole.nearest].sheet != no_triangle)
            whole.behind = sheet_behind(mesh, whole.nearest, point);
    for (std::size_t k = 0; k < triangles.size(); ++k)
        if (const auto side = pieces[piece[k]].behind) behind[k] = *side;
}

}  // namespace tumble
