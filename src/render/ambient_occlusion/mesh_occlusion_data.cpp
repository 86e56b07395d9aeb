#include "render/ambient_occlusion/mesh_occlusion_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace tumble {
namespace {

constexpr int cells_along_longest = 12;
constexpr std::size_t most_boxes = 16;  // every pixel near the body computes the distance to each of them

using Cell = std::array<int, 3>;

// A grid of cells, each inside the mesh or not.
class Lattice {
public:
    explicit Lattice(const TriangleMesh& mesh) : bounds_(mesh.bounds()) {
        const Vec3 extent = bounds_.extent();
        const double wanted = extent.maxCoeff() / cells_along_longest;
        for (int k = 0; k < 3; ++k) counts_[std::size_t(k)] = std::max(1, int(std::ceil(extent[k] / wanted - 1e-9)));
        size_ = extent.cwiseQuotient(Vec3(counts_[0], counts_[1], counts_[2]));
        inside_.assign(std::size_t(counts_[0]) * std::size_t(counts_[1]) * std::size_t(counts_[2]), false);
        for (int y = 0; y < counts_[1]; ++y)
            for (int z = 0; z < counts_[2]; ++z) fill_row(mesh, y, z);
    }

    const Cell& counts() const { return counts_; }
    bool inside(const Cell& c) const { return inside_[index(c)]; }
    void clear(const Cell& c) { inside_[index(c)] = false; }

    OccluderBox box(const Cell& low, const Cell& high) const {  // high: one past the last cell
        const Vec3 a(low[0], low[1], low[2]), b(high[0], high[1], high[2]);
        return {bounds_.min + (0.5 * (a + b)).cwiseProduct(size_), (0.5 * (b - a)).cwiseProduct(size_)};
    }

private:
    std::size_t index(const Cell& c) const {
        return (std::size_t(c[2]) * std::size_t(counts_[1]) + std::size_t(c[1])) * std::size_t(counts_[0]) +
               std::size_t(c[0]);
    }

    // Crossings of the mesh with the line along x through the cells' centers; a point is inside after an odd number of
    // them.
    void fill_row(const TriangleMesh& mesh, int y, int z) {
        // Offset from the centers by a fraction that no regular grid of vertices shares, so that the line meets no
        // edge.
        const double line_y = bounds_.min.y() + (y + 0.5000317) * size_.y();
        const double line_z = bounds_.min.z() + (z + 0.5000731) * size_.z();
        std::vector<double> crossings;
        for (const auto& triangle : mesh.triangles) {
            const Vec3 &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                       &c = mesh.vertices[triangle[2]];
            const auto side = [&](const Vec3& p, const Vec3& q) {
                return (q.y() - p.y()) * (line_z - p.z()) - (q.z() - p.z()) * (line_y - p.y());
            };
            const double u = side(b, c), v = side(c, a), w = side(a, b);
            if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) continue;
            const double sum = u + v + w;
            if (sum != 0.0) crossings.push_back((u * a.x() + v * b.x() + w * c.x()) / sum);
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
            for (int x = 0; x < counts_[0]; ++x) {
                const double center = bounds_.min.x() + (x + 0.5) * size_.x();
                if (crossings[i] < center && center < crossings[i + 1]) inside_[index({x, y, z})] = true;
            }
    }

    Bounds bounds_;
    Cell counts_{};
    Vec3 size_;
    std::vector<bool> inside_;
};

// Grows a box from a full cell as long as all cells in it are full: along x, then y, then z.
OccluderBox take_box(Lattice& lattice, const Cell& first) {
    Cell high = {first[0] + 1, first[1] + 1, first[2] + 1};
    const auto full = [&](const Cell& from, const Cell& to) {
        for (int z = from[2]; z < to[2]; ++z)
            for (int y = from[1]; y < to[1]; ++y)
                for (int x = from[0]; x < to[0]; ++x)
                    if (!lattice.inside({x, y, z})) return false;
        return true;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        while (high[axis] < lattice.counts()[axis]) {
            Cell from = first, to = high;
            from[axis] = high[axis];
            to[axis] = high[axis] + 1;
            if (!full(from, to)) break;
            ++high[axis];
        }
    for (int z = first[2]; z < high[2]; ++z)
        for (int y = first[1]; y < high[1]; ++y)
            for (int x = first[0]; x < high[0]; ++x) lattice.clear({x, y, z});
    return lattice.box(first, high);
}

}  // namespace

std::vector<OccluderBox> make_mesh_occluders(const TriangleMesh& mesh) {
    std::vector<OccluderBox> boxes;
    if (mesh.triangles.empty() || !closedness(mesh).closed() || !(mesh.bounds().extent().minCoeff() > 0.0))
        return boxes;
    Lattice lattice(mesh);
    for (int z = 0; z < lattice.counts()[2]; ++z)
        for (int y = 0; y < lattice.counts()[1]; ++y)
            for (int x = 0; x < lattice.counts()[0]; ++x)
                if (lattice.inside({x, y, z})) boxes.push_back(take_box(lattice, {x, y, z}));
    std::stable_sort(boxes.begin(), boxes.end(), [](const OccluderBox& a, const OccluderBox& b) {
        return a.half_size.prod() > b.half_size.prod();
    });
    if (boxes.size() > most_boxes) boxes.resize(most_boxes);
    return boxes;
}

namespace {

constexpr std::size_t most_samples = 2000;  // each is recomputed in every frame, for every body with this mesh
constexpr std::size_t most_coarse_samples = 64;

Vec3 vec3(const float (&v)[3]) { return {double(v[0]), double(v[1]), double(v[2])}; }

// Grid cell and octant of a point.
using Group = std::array<int, 4>;

Group group_of(const VertexSample& point, const Vec3& low, double cell) {
    const Vec3 at = (point.position - low) / cell;
    const int octant = (point.normal[0] < 0.0) + 2 * (point.normal[1] < 0.0) + 4 * (point.normal[2] < 0.0);
    return {int(std::floor(at.x())), int(std::floor(at.y())), int(std::floor(at.z())), octant};
}

bool share(const RenderMesh& mesh, const std::vector<VertexSample>& points, double cell, std::size_t most,
           std::vector<VertexSample>& shared, std::vector<std::uint32_t>& of_point) {
    shared.clear();
    of_point.clear();
    std::map<Group, std::uint32_t> groups;
    const Vec3 low = mesh.bound_center - mesh.half_extent;
    for (const VertexSample& point : points) {
        const auto [place, is_new] = groups.try_emplace(group_of(point, low, cell), std::uint32_t(shared.size()));
        if (is_new) shared.push_back(point);
        of_point.push_back(place->second);
        if (shared.size() > most) return false;
    }
    return true;
}

// Shares samples among vertices, with the finest grid that `most` samples allow.
void share(const RenderMesh& mesh, const std::vector<VertexSample>& points, std::size_t most,
           std::vector<VertexSample>& shared, std::vector<std::uint32_t>& of_point) {
    if (points.size() <= most) {
        shared = points;
        of_point.resize(points.size());
        std::iota(of_point.begin(), of_point.end(), 0u);
        return;
    }
    double cell = std::max(mesh.half_extent.maxCoeff(), 1e-30) / 32.0;
    while (!share(mesh, points, cell, most, shared, of_point)) cell *= 1.25;
}

}  // namespace

void set_vertex_samples(RenderMesh& mesh) {
    std::vector<VertexSample> vertices;
    for (const MeshAsset::Vertex& vertex : mesh.asset->vertices)
        vertices.push_back({vec3(vertex.position), vec3(vertex.normal)});
    share(mesh, vertices, most_samples, mesh.vertex_samples, mesh.sample_of_vertex);
    share(mesh, mesh.vertex_samples, most_coarse_samples, mesh.coarse_samples, mesh.coarse_of_sample);
}

}  // namespace tumble
