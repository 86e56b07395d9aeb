#include "scene/fracture/convex_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr std::uint32_t unused = ~std::uint32_t(0);

/// Vertices where edges cross a plane, each made once for the two faces of its edge.
class Crossings {
public:
    Crossings(std::vector<Vec3>& vertices, const std::vector<double>& side) : vertices_(vertices), side_(side) {}

    std::uint32_t between(std::uint32_t a, std::uint32_t b) {
        if (side_[a] > side_[b]) std::swap(a, b);
        for (const Crossing& one : made_)
            if (one.inside == a && one.outside == b) return one.vertex;
        const double share = side_[a] / (side_[a] - side_[b]);
        const Vec3 p = vertices_[a] + share * (vertices_[b] - vertices_[a]);
        made_.push_back({a, b, std::uint32_t(vertices_.size())});
        vertices_.push_back(p);
        return made_.back().vertex;
    }

private:
    struct Crossing {
        std::uint32_t inside, outside, vertex;
    };
    std::vector<Vec3>& vertices_;
    const std::vector<double>& side_;
    std::vector<Crossing> made_;
};

/// The loop of edges `next[v]`, which joins all of them; empty if they form none.
std::vector<std::uint32_t> loop_of(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges) {
    std::vector<std::uint32_t> loop;
    if (edges.size() < 3) return loop;
    std::uint32_t at = edges.front().first;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        loop.push_back(at);
        const auto next = std::find_if(edges.begin(), edges.end(), [&](const auto& edge) { return edge.first == at; });
        if (next == edges.end()) return {};
        at = next->second;
        if (at == loop.front() && i + 1 < edges.size()) return {};
    }
    return at == loop.front() ? loop : std::vector<std::uint32_t>();
}

}  // namespace

Bounds ConvexCell::bounds() const {
    Bounds all;
    for (const Vec3& v : vertices) all.add(v);
    return all;
}

double ConvexCell::volume() const {
    if (empty()) return 0.0;
    const Vec3& apex = vertices.front();
    double six = 0.0;
    for (const Face& face : faces)
        for (std::size_t i = 2; i < face.vertices.size(); ++i) {
            const Vec3 a = vertices[face.vertices[0]] - apex, b = vertices[face.vertices[i - 1]] - apex,
                       c = vertices[face.vertices[i]] - apex;
            six += a.dot(b.cross(c));
        }
    return six / 6.0;
}

TriangleMesh ConvexCell::mesh() const {
    TriangleMesh mesh;
    mesh.vertices = vertices;
    for (const Face& face : faces)
        for (std::size_t i = 2; i < face.vertices.size(); ++i)
            mesh.triangles.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
    return mesh;
}

// A cut along a vertex or an edge can be ambiguous by rounding; one a little farther out is not.
void ConvexCell::clip(CutPlane plane, double tolerance) {
    while (!try_clip(plane, tolerance)) plane.offset += 8.0 * tolerance;
}

bool ConvexCell::try_clip(const CutPlane& plane, double tolerance) {
    std::vector<double> side;
    double least = 0.0, most = 0.0;
    for (const Vec3& v : vertices) {
        double s = plane.normal.dot(v) - plane.offset;
        if (std::abs(s) <= tolerance) s = 0.0;
        least = std::min(least, s);
        most = std::max(most, s);
        side.push_back(s);
    }
    if (most == 0.0 && least < 0.0) return true;
    if (least == 0.0) {
        *this = {};
        return true;
    }
    std::vector<Vec3> all = vertices;
    Crossings crossings(all, side);
    std::vector<Face> kept;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> rim;  // of the new face
    const auto on_plane = [&](std::uint32_t v) { return v >= side.size() || side[v] == 0.0; };
    for (const Face& face : faces) {
        Face cut{face.normal, face.offset, {}, face.outer};
        for (std::size_t i = 0; i < face.vertices.size(); ++i) {
            const std::uint32_t a = face.vertices[i], b = face.vertices[(i + 1) % face.vertices.size()];
            if (side[a] <= 0.0) cut.vertices.push_back(a);
            if (side[a] * side[b] < 0.0) cut.vertices.push_back(crossings.between(a, b));
        }
        if (cut.vertices.size() < 3 || std::all_of(cut.vertices.begin(), cut.vertices.end(), on_plane)) continue;
        for (std::size_t i = 0; i < cut.vertices.size(); ++i) {
            const std::uint32_t a = cut.vertices[i], b = cut.vertices[(i + 1) % cut.vertices.size()];
            if (on_plane(a) && on_plane(b)) rim.emplace_back(b, a);
        }
        kept.push_back(std::move(cut));
    }
    Face made{plane.normal, plane.offset, loop_of(rim), false};
    if (made.vertices.empty()) return false;
    kept.push_back(std::move(made));
    vertices = std::move(all);
    faces = std::move(kept);
    drop_unused_vertices();
    return true;
}

void ConvexCell::drop_unused_vertices() {
    std::vector<std::uint32_t> place(vertices.size(), unused);
    std::vector<Vec3> used;
    for (Face& face : faces)
        for (std::uint32_t& v : face.vertices) {
            if (place[v] == unused) {
                place[v] = std::uint32_t(used.size());
                used.push_back(vertices[v]);
            }
            v = place[v];
        }
    vertices = std::move(used);
}

void ConvexCell::weld(double tolerance) {
    std::vector<std::uint32_t> same(vertices.size());
    bool merges = false;
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        same[v] = v;
        for (std::uint32_t u = 0; u < v && same[v] == v; ++u)
            if (same[u] == u && (vertices[u] - vertices[v]).squaredNorm() <= tolerance * tolerance) same[v] = u;
        merges = merges || same[v] != v;
    }
    if (!merges) return;
    std::vector<Face> kept;
    for (Face& face : faces) {
        std::vector<std::uint32_t> loop;
        for (const std::uint32_t v : face.vertices)
            if (loop.empty() || loop.back() != same[v]) loop.push_back(same[v]);
        while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
        if (loop.size() < 3) continue;
        face.vertices = std::move(loop);
        kept.push_back(std::move(face));
    }
    faces = std::move(kept);
    drop_unused_vertices();
}

}  // namespace tumble
