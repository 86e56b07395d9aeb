#include "sim/geometry/shapes/hull.h"

#include "core/disjoint_sets.h"
#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace tumble {
namespace {

// Owns Qhull's state and everything that it allocates.
struct QhullRun {
    qhT state{};
    QhullRun() { qh_zero(&state, nullptr); }
    ~QhullRun() {
        qh_freeqhull(&state, qh_ALL);
        int current = 0, total = 0;
        qh_memfreeshort(&state, &current, &total);
    }
    QhullRun(const QhullRun&) = delete;
    QhullRun& operator=(const QhullRun&) = delete;
};

// Qhull writes its messages to a FILE; a library layer prints nothing, so they go to memory and into the error.
struct MessageFile {
    char* text = nullptr;
    std::size_t length = 0;
    std::FILE* file = open_memstream(&text, &length);
    ~MessageFile() {
        std::fclose(file);
        std::free(text);
    }
};

}  // namespace

void Polyhedron::complete() {
    edges.clear();
    bounds = {};
    radius = 0.0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edge_of;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        Face& face = faces[f];
        // Newell's normal: exact for a plane polygon, the best fit for one that rounding has bent.
        Vec3 normal = Vec3::Zero(), center = Vec3::Zero();
        const std::size_t n = face.vertices.size();
        const Vec3& first = vertices[face.vertices[0]];
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 a = vertices[face.vertices[i]] - first, b = vertices[face.vertices[(i + 1) % n]] - first;
            normal += a.cross(b);
            center += vertices[face.vertices[i]];
        }
        face.normal = normal.normalized();
        face.offset = face.normal.dot(center) / double(n);
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t a = face.vertices[i], b = face.vertices[(i + 1) % n];
            const auto key = std::minmax(a, b);
            const auto found = edge_of.find(key);
            if (found == edge_of.end()) {
                edge_of.emplace(key, edges.size());
                edges.push_back({a, b, std::uint32_t(f), std::uint32_t(f)});
            } else {
                edges[found->second].right = std::uint32_t(f);
            }
        }
    }
    for (const Vec3& v : vertices) {
        bounds.add(v);
        radius = std::max(radius, v.norm());
    }
    inner_radius = radius;
    for (const Face& face : faces) inner_radius = std::max(0.0, std::min(inner_radius, face.offset));

    std::vector<Bounds> edge_bounds(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        edge_bounds[e].add(vertices[edges[e].tail]);
        edge_bounds[e].add(vertices[edges[e].head]);
    }
    edge_tree = BoundsTree(std::move(edge_bounds));

    first_neighbor.assign(vertices.size() + 1, 0);
    for (const Edge& e : edges) ++first_neighbor[e.tail + 1], ++first_neighbor[e.head + 1];
    for (std::size_t i = 1; i < first_neighbor.size(); ++i) first_neighbor[i] += first_neighbor[i - 1];
    neighbors.resize(2 * edges.size());
    std::vector<std::uint32_t> next(first_neighbor.begin(), first_neighbor.end() - 1);
    for (const Edge& e : edges) {
        neighbors[next[e.tail]++] = e.head;
        neighbors[next[e.head]++] = e.tail;
    }
}

std::uint32_t Polyhedron::support(const Vec3& direction, std::uint32_t start) const {
    std::uint32_t best = start;
    double farthest = direction.dot(vertices[best]);
    while (true) {
        const std::uint32_t from = best;
        for (std::uint32_t k = first_neighbor[from]; k < first_neighbor[from + 1]; ++k) {
            const double d = direction.dot(vertices[neighbors[k]]);
            if (d > farthest) {
                farthest = d;
                best = neighbors[k];
            }
        }
        if (best == from) return best;
    }
}

std::uint32_t Polyhedron::face_at_support(const Vec3& direction, double depth) const {
    const std::uint32_t farthest = support(direction);
    const double level = direction.dot(vertices[farthest]) - depth;
    std::uint32_t best = 0;
    std::ptrdiff_t best_count = 0;
    double most = 0.0;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const std::vector<std::uint32_t>& loop = faces[i].vertices;
        if (std::find(loop.begin(), loop.end(), farthest) == loop.end()) continue;
        const auto count = std::count_if(loop.begin(), loop.end(),
                                         [&](std::uint32_t v) { return direction.dot(vertices[v]) >= level; });
        const double d = direction.dot(faces[i].normal);
        if (count > best_count || (count == best_count && d > most)) {
            best = i;
            best_count = count;
            most = d;
        }
    }
    return best;
}

double Polyhedron::surface_area() const {
    double area = 0.0;
    for (const Face& face : faces) {
        const Vec3& first = vertices[face.vertices[0]];
        for (std::size_t i = 2; i < face.vertices.size(); ++i) {
            const Vec3 a = vertices[face.vertices[i - 1]] - first, b = vertices[face.vertices[i]] - first;
            area += 0.5 * a.cross(b).norm();
        }
    }
    return area;
}

bool Polyhedron::contains(const Vec3& point, double tolerance) const {
    return std::all_of(faces.begin(), faces.end(),
                       [&](const Face& f) { return f.normal.dot(point) <= f.offset + tolerance; });
}

// Qhull merges coplanar facets, which gives true polygons.
Polyhedron make_hull(const std::vector<Vec3>& points, const Vec3& origin) {
    std::vector<double> coordinates;
    coordinates.reserve(3 * points.size());
    for (const Vec3& p : points) {
        const Vec3 local = p - origin;
        coordinates.insert(coordinates.end(), {local.x(), local.y(), local.z()});
    }
    MessageFile messages;
    QhullRun run;
    qhT* qh = &run.state;
    char options[] = "qhull";
    const int failed = points.size() < 4 ? 1
                                         : qh_new_qhull(qh, 3, int(points.size()), coordinates.data(), False, options,
                                                        nullptr, messages.file);
    if (failed)
        throw InputError(
            fmt::format("the convex hull of {} points has no volume (they lie in one plane)", points.size()));

    Polyhedron hull;
    std::vector<std::uint32_t> index_of(points.size(), UINT32_MAX);
    facetT* facet;
    FORALLfacets {
        Polyhedron::Face face;
        setT* loop = qh_facet3vertex(qh, facet);  // in order, counterclockwise from outside
        vertexT *vertex, **vertexp;
        FOREACHvertex_(loop) {
            const int id = qh_pointid(qh, vertex->point);
            if (index_of[std::size_t(id)] == UINT32_MAX) {
                index_of[std::size_t(id)] = std::uint32_t(hull.vertices.size());
                const double* c = coordinates.data() + 3 * id;
                hull.vertices.emplace_back(c[0], c[1], c[2]);
            }
            face.vertices.push_back(index_of[std::size_t(id)]);
        }
        qh_settempfree(qh, &loop);
        hull.faces.push_back(std::move(face));
    }
    hull.complete();
    // Qhull's orientation varies; outward is away from a point inside.
    Vec3 inside = Vec3::Zero();
    for (const Vec3& v : hull.vertices) inside += v;
    inside /= double(hull.vertices.size());
    if (hull.faces[0].normal.dot(inside) > hull.faces[0].offset) {
        for (auto& face : hull.faces) std::reverse(face.vertices.begin(), face.vertices.end());
        hull.complete();
    }
    return hull;
}

namespace {

using HullEdge = std::pair<std::uint32_t, std::uint32_t>;  // vertices in the order of its triangle

/// The group of each triangle: coplanar neighbors share the lowest index among them.
std::vector<std::size_t> coplanar_groups(const TriangleMesh& mesh, const std::vector<Vec3>& normals,
                                         const std::map<HullEdge, std::size_t>& triangle_of) {
    constexpr double same = 1.0 - 1e-12;  // cosine: angles up to 1.4e-6, of slivers that are welded
    DisjointSets groups(mesh.triangles.size());
    for (const auto& [edge, triangle] : triangle_of) {
        const std::size_t other = triangle_of.at({edge.second, edge.first});
        if (normals[triangle].dot(normals[other]) >= same) groups.join(triangle, other);
    }
    std::vector<std::size_t> group(mesh.triangles.size());
    for (std::size_t t = 0; t < group.size(); ++t) group[t] = groups.root(t);
    return group;
}

/// The one loop of these edges by their tails; empty if they form none or several.
std::vector<std::uint32_t> only_loop(const std::map<std::uint32_t, std::uint32_t>& head_of) {
    std::vector<std::uint32_t> loop;
    std::uint32_t at = head_of.begin()->first;
    do {
        const auto next = head_of.find(at);
        if (next == head_of.end() || loop.size() == head_of.size()) return {};
        loop.push_back(at);
        at = next->second;
    } while (at != loop.front());
    return loop.size() == head_of.size() ? loop : std::vector<std::uint32_t>();
}

/// Drops vertices within faces and within edges.
void drop_flat_vertices(Polyhedron& hull) {
    std::vector<int> faces_at(hull.vertices.size(), 0);
    for (const Polyhedron::Face& face : hull.faces)
        for (const std::uint32_t v : face.vertices) ++faces_at[v];
    std::vector<std::uint32_t> place(hull.vertices.size());
    std::vector<Vec3> kept;
    for (std::size_t v = 0; v < place.size(); ++v) {
        place[v] = std::uint32_t(kept.size());
        if (faces_at[v] > 2) kept.push_back(hull.vertices[v]);
    }
    for (Polyhedron::Face& face : hull.faces) {
        std::erase_if(face.vertices, [&](std::uint32_t v) { return faces_at[v] <= 2; });
        for (std::uint32_t& v : face.vertices) v = place[v];
    }
    hull.vertices = std::move(kept);
}

}  // namespace

std::optional<Polyhedron> convex_polyhedron(const TriangleMesh& mesh, const Vec3& origin) {
    constexpr double rounding = 1e-9;  // of the size: the weld of meshes
    if (mesh.triangles.size() < 4 || !closedness(mesh).closed()) return std::nullopt;
    std::map<HullEdge, std::size_t> triangle_of;
    std::vector<Vec3> normals;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& v = mesh.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) triangle_of[{v[i], v[(i + 1) % 3]}] = t;
        const Vec3 a = mesh.vertices[v[0]];
        normals.push_back((mesh.vertices[v[1]] - a).cross(mesh.vertices[v[2]] - a).normalized());
    }
    const std::vector<std::size_t> group = coplanar_groups(mesh, normals, triangle_of);
    std::vector<std::map<std::uint32_t, std::uint32_t>> rims(mesh.triangles.size());
    for (const auto& [edge, triangle] : triangle_of)
        if (group[triangle] != group[triangle_of.at({edge.second, edge.first})])
            rims[group[triangle]][edge.first] = edge.second;
    Polyhedron hull;
    for (const Vec3& v : mesh.vertices) hull.vertices.push_back(v - origin);
    for (const auto& rim : rims) {
        if (rim.empty()) continue;
        Polyhedron::Face face;
        face.vertices = only_loop(rim);
        if (face.vertices.size() < 3) return std::nullopt;
        hull.faces.push_back(std::move(face));
    }
    drop_flat_vertices(hull);
    for (const Polyhedron::Face& face : hull.faces)
        if (face.vertices.size() < 3) return std::nullopt;
    if (hull.faces.size() < 4) return std::nullopt;
    hull.complete();
    const double tolerance = rounding * hull.bounds.extent().norm();
    for (const Polyhedron::Face& face : hull.faces)
        for (const Vec3& v : hull.vertices)
            if (!(face.normal.dot(v) <= face.offset + tolerance)) return std::nullopt;
    return hull;
}

}  // namespace tumble
