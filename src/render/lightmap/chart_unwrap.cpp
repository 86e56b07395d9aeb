#include "render/lightmap/chart_unwrap.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace tumble {
namespace {

constexpr std::uint32_t none = ~0u;

// Largest number of texels along the mesh's longest side: charts must fit into the atlas.
constexpr double most_along = 1000.0;

// Texels around a chart's triangles that hold values as well: interpolation reads those nearer than the square root of
// 2.
constexpr double rim = 1.5;

// A texel shades points within one texel of it, plus a tenth for rounding; there the surface rises by as much across
// and along.
constexpr double most_rise = 2.2;  // texels

// Height difference above which two surfaces of one chart at one place are two floors. Two that meet at an edge differ
// by 1.4 half a texel beyond it.
constexpr double most_step = 1.5;  // texels

struct ChartTriangle {
    std::array<Eigen::Vector3d, 3> corners;  // texels: the chart's two axes, then the projection axis
    int side = 0;                            // twice that axis; plus one if it faces along it
    int chart = -1;
    Eigen::Vector3d edge[3];  // distance of (a, b) from each side, inward: x a + y b + z, texels
    Eigen::Vector3d rise;     // height over (a, b), in the same form
    double outside(double a, double b) const {
        double most = -1e30;
        for (const Eigen::Vector3d& e : edge) most = std::max(most, -(e.x() * a + e.y() * b + e.z()));
        return most;
    }
    double height(double a, double b) const { return rise.x() * a + rise.y() * b + rise.z(); }
    double low(int k) const { return std::min({corners[0][k], corners[1][k], corners[2][k]}); }
    double high(int k) const { return std::max({corners[0][k], corners[1][k], corners[2][k]}); }
};

Vec3 vec3(const float (&v)[3]) { return {double(v[0]), double(v[1]), double(v[2])}; }

class Unfolding {
public:
    Unfolding(const MeshAsset& asset, double cell) : asset_(asset), cell_(cell) {}

    std::optional<ChartedMesh> run(std::size_t most_texels) {
        Bounds bounds;
        for (const MeshAsset::Vertex& v : asset_.vertices) bounds.add(vec3(v.position));
        if (!(bounds.extent().maxCoeff() < most_along * cell_)) return std::nullopt;
        low_ = bounds.min;
        for (int k = 0; k < 3; ++k) count_[std::size_t(k)] = int(bounds.extent()[k] / cell_) + 4;
        read_triangles();
        find_neighbours();
        for (std::size_t i = 0; i < triangles_.size(); ++i)
            if (triangles_[i].chart < 0) grow(i);
        if (!lay_out(most_texels)) return std::nullopt;
        place_vertices();
        fill();
        return std::move(result_);
    }

private:
    // Texel (1, 1) is at the mesh's low corner.
    Eigen::Vector3d on_chart(const Vec3& position, int axis) const {
        const Vec3 at = (position - low_) / cell_ + Vec3::Ones();
        return {at[(axis + 1) % 3], at[(axis + 2) % 3], at[axis]};
    }
    Vec3 in_body(const Eigen::Vector3d& at, int axis) const {
        Vec3 p;
        p[(axis + 1) % 3] = at[0];
        p[(axis + 2) % 3] = at[1];
        p[axis] = at[2];
        return low_ + cell_ * (p - Vec3::Ones());
    }

    void read_triangles() {
        triangles_.resize(asset_.indices.size() / 3);
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            ChartTriangle& t = triangles_[i];
            std::array<Vec3, 3> p;
            for (std::size_t k = 0; k < 3; ++k) p[k] = vec3(asset_.vertices[asset_.indices[3 * i + k]].position);
            const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
            int axis = 0;
            normal.cwiseAbs().maxCoeff(&axis);
            t.side = 2 * axis + (normal[axis] > 0.0 ? 1 : 0);
            for (std::size_t k = 0; k < 3; ++k) t.corners[k] = on_chart(p[k], axis);
            const double turn = normal[axis] > 0.0 ? 1.0 : -1.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const Eigen::Vector3d &a = t.corners[k], &b = t.corners[(k + 1) % 3];
                const double x = -turn * (b.y() - a.y()), y = turn * (b.x() - a.x());
                const double length = std::max(std::hypot(x, y), 1e-30);
                t.edge[k] = Eigen::Vector3d(x, y, -(x * a.x() + y * a.y())) / length;
            }
            const double up = normal[axis] != 0.0 ? normal[axis] : 1.0;
            const double along = -normal[(axis + 1) % 3] / up, across = -normal[(axis + 2) % 3] / up;
            t.rise = {along, across, t.corners[0].z() - along * t.corners[0].x() - across * t.corners[0].y()};
        }
    }

    // By edges between equal positions.
    void find_neighbours() {
        const auto place = [&](std::uint32_t vertex) {
            const float(&p)[3] = asset_.vertices[vertex].position;
            return std::tie(p[0], p[1], p[2]);
        };
        std::vector<std::uint32_t> order(asset_.vertices.size()), point(order.size());
        std::iota(order.begin(), order.end(), 0u);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
        for (std::size_t i = 0; i < order.size(); ++i)  // each vertex is represented by the first one at its position
            point[order[i]] = i > 0 && place(order[i]) == place(order[i - 1]) ? point[order[i - 1]] : order[i];
        struct Edge {
            std::uint64_t points;
            std::uint32_t side;  // of a triangle: three times its index, plus the index of the side
        };
        std::vector<Edge> edges;
        edges.reserve(asset_.indices.size());
        for (std::size_t i = 0; i < asset_.indices.size(); ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            const auto [low, high] = std::minmax({point[asset_.indices[i]], point[asset_.indices[next]]});
            edges.push_back({std::uint64_t(low) << 32 | high, std::uint32_t(i)});
        }
        std::sort(edges.begin(), edges.end(),
                  [](const Edge& a, const Edge& b) { return std::tie(a.points, a.side) < std::tie(b.points, b.side); });
        neighbours_.assign(asset_.indices.size(), none);
        for (std::size_t i = 1; i < edges.size();
             ++i)  // where more than two triangles meet, they are paired in another way
            if (edges[i].points == edges[i - 1].points) {
                neighbours_[edges[i].side] = edges[i - 1].side / 3;
                neighbours_[edges[i - 1].side] = edges[i].side / 3;
            }
    }

    template <class See>
    static void visit(const ChartTriangle& t, double around, See see) {
        const int a1 = int(std::floor(t.high(0) + around)), b1 = int(std::floor(t.high(1) + around));
        for (int b = int(std::ceil(t.low(1) - around)); b <= b1; ++b)
            for (int a = int(std::ceil(t.low(0) - around)); a <= a1; ++a)
                if (const double out = t.outside(a, b); out <= around) see(a, b, out);
    }

    // Grows a chart from this triangle over its neighbors. The chart ends where the surface would overlap itself, as in
    // a spiral.
    void grow(std::size_t first) {
        const int chart = int(sides_.size()), side = triangles_[first].side, axis = side / 2;
        sides_.push_back(side);
        std::vector<Seen>& seen = seen_[std::size_t(axis)];
        const int columns = count_[std::size_t((axis + 1) % 3)];
        if (seen.empty()) seen.resize(std::size_t(columns) * std::size_t(count_[std::size_t((axis + 2) % 3)]));
        std::vector<std::size_t> open = {first};
        for (std::size_t next = 0; next < open.size(); ++next) {
            ChartTriangle& t = triangles_[open[next]];
            if (t.chart >= 0) continue;
            bool fits = true;
            const auto place = [&](int a, int b) -> Seen& {
                return seen[std::size_t(b) * std::size_t(columns) + std::size_t(a)];
            };
            visit(t, 0.5, [&](int a, int b, double) {
                const Seen& there = place(a, b);
                if (there.chart == chart && std::abs(there.height - t.height(a, b)) > most_step) fits = false;
            });
            if (!fits) continue;
            t.chart = chart;
            visit(t, 0.5, [&](int a, int b, double) { place(a, b) = {chart, float(t.height(a, b))}; });
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t n = neighbours_[3 * open[next] + k];
                if (n != none && triangles_[n].chart < 0 && triangles_[n].side == side) open.push_back(n);
            }
        }
    }

    // On shelves, the highest chart first.
    bool lay_out(std::size_t most_texels) {
        struct Range {
            int a0 = 1 << 30, a1 = -1, b0 = 1 << 30, b1 = -1;
        };
        std::vector<Range> ranges(sides_.size());
        for (const ChartTriangle& t : triangles_) {
            Range& r = ranges[std::size_t(t.chart)];
            r.a0 = std::min(r.a0, int(std::floor(t.low(0))) - 1);
            r.b0 = std::min(r.b0, int(std::floor(t.low(1))) - 1);
            r.a1 = std::max(r.a1, int(std::ceil(t.high(0))) + 1);
            r.b1 = std::max(r.b1, int(std::ceil(t.high(1))) + 1);
        }
        std::size_t all = 0;
        int widest = 0;
        for (const Range& r : ranges) {
            all += std::size_t(r.a1 - r.a0 + 1) * std::size_t(r.b1 - r.b0 + 1);
            widest = std::max(widest, r.a1 - r.a0 + 1);
            result_.charts.push_back({0, 0, r.a1 - r.a0 + 1, r.b1 - r.b0 + 1, sides_[result_.charts.size()] / 2});
            first_.push_back({r.a0, r.b0});
        }
        if (all > most_texels) return false;
        std::vector<std::size_t> order(ranges.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return result_.charts[a].height > result_.charts[b].height;
        });
        result_.width = std::max(widest, std::min(int(1.1 * std::sqrt(double(all))) + 1, int(most_along)));
        int x = 0, y = 0, shelf = 0;
        for (const std::size_t i : order) {
            ChartedMesh::Chart& c = result_.charts[i];
            if (x + c.width > result_.width) {
                x = 0;
                y += shelf;
                shelf = 0;
            }
            c.x = x;
            c.y = y;
            x += c.width;
            shelf = std::max(shelf, c.height);
        }
        result_.height = y + shelf;
        result_.cell = cell_;
        return std::size_t(result_.width) * std::size_t(result_.height) <= 2 * most_texels;
    }

    void place_vertices() {
        std::vector<std::uint32_t> latest(asset_.vertices.size(), none), before;  // chart copies of each vertex
        std::vector<int> chart;                                                   // chart of each copy
        for (std::size_t i = 0; i < asset_.indices.size(); ++i) {
            const ChartTriangle& t = triangles_[i / 3];
            std::uint32_t& last = latest[asset_.indices[i]];
            std::uint32_t known = last;
            while (known != none && chart[known] != t.chart) known = before[known];
            if (known != none) {
                result_.indices.push_back(known);
                continue;
            }
            before.push_back(last);
            chart.push_back(t.chart);
            last = std::uint32_t(result_.vertices.size());
            result_.indices.push_back(last);
            const ChartedMesh::Chart& c = result_.charts[std::size_t(t.chart)];
            const auto& from = first_[std::size_t(t.chart)];
            result_.vertices.push_back(asset_.vertices[asset_.indices[i]]);
            result_.texels.push_back(
                {float(t.corners[i % 3].x() - from[0] + c.x), float(t.corners[i % 3].y() - from[1] + c.y)});
        }
    }

    // Each texel takes its point from the triangle that contains it, otherwise from the nearest triangle.
    void fill() {
        const std::size_t count = std::size_t(result_.width) * std::size_t(result_.height);
        result_.positions.resize(count);
        result_.normals.resize(count);
        result_.heights.assign(count, {1.0f, 0.0f});
        std::vector<float> nearest(count, float(rim));
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const ChartTriangle& t = triangles_[i];
            const ChartedMesh::Chart& c = result_.charts[std::size_t(t.chart)];
            const auto& from = first_[std::size_t(t.chart)];
            visit(t, rim, [&](int a, int b, double outside) {
                const int x = a - from[0], y = b - from[1];
                if (x < 0 || y < 0 || x >= c.width || y >= c.height) return;
                const std::size_t at = std::size_t(y + c.y) * std::size_t(result_.width) + std::size_t(x + c.x);
                const double height = t.height(a, b);
                const auto out = float(std::max(outside, 0.0));
                const bool used = result_.used(at);
                auto& [low, high] = result_.heights[at];
                const auto metres = [&](double z) { return float(in_body({0.0, 0.0, z}, c.axis)[c.axis]); };
                const float from_low = metres(std::clamp(height - most_rise, t.low(2), t.high(2)));
                const float to_high = metres(std::clamp(height + most_rise, t.low(2), t.high(2)));
                low = used ? std::min(low, from_low) : from_low;
                high = used ? std::max(high, to_high) : to_high;
                if (used && out >= nearest[at]) return;
                nearest[at] = out;
                put(in_body({double(a), double(b), height}, c.axis), result_.positions[at]);
                put(normal_at(i, a, b), result_.normals[at]);
            });
        }
    }

    static void put(const Vec3& from, std::array<float, 3>& to) {
        to = {float(from.x()), float(from.y()), float(from.z())};
    }

    // Interpolated between the corners' normals, as in shading.
    Vec3 normal_at(std::size_t triangle, double a, double b) const {
        const ChartTriangle& t = triangles_[triangle];
        Vec3 sum = Vec3::Zero();
        // weight of a corner: distance from the opposite side, over the corner's own distance
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector3d& e = t.edge[(k + 1) % 3];
            const double own = std::max(e.x() * t.corners[k].x() + e.y() * t.corners[k].y() + e.z(), 1e-30);
            const double share = std::clamp((e.x() * a + e.y() * b + e.z()) / own, 0.0, 1.0);
            sum += share * vec3(asset_.vertices[asset_.indices[3 * triangle + k]].normal);
        }
        const double length = sum.norm();
        return length > 1e-6 ? Vec3(sum / length) : vec3(asset_.vertices[asset_.indices[3 * triangle]].normal);
    }

    struct Seen {
        int chart = -1;
        float height = 0.0f;  // texels
    };
    const MeshAsset& asset_;
    double cell_;
    Vec3 low_ = Vec3::Zero();
    std::array<int, 3> count_{};  // texels along each axis
    std::vector<ChartTriangle> triangles_;
    std::vector<std::uint32_t> neighbours_;  // three per triangle
    std::array<std::vector<Seen>, 3> seen_;  // along each axis: the chart that was entered there last
    std::vector<int> sides_;                 // of each chart
    std::vector<std::array<int, 2>> first_;  // first texel of each chart, before packing
    ChartedMesh result_;
};

}  // namespace

std::optional<ChartedMesh> make_mesh_charts(const MeshAsset& asset, double cell, std::size_t most_texels) {
    return Unfolding(asset, cell).run(most_texels);
}

}  // namespace tumble
