#include "scene/mesh/curved_mesh.h"

#include "core/deterministic_math.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {
namespace {

constexpr int flat_sides = 96;   // of round sides and discs
constexpr int round_sides = 64;  // of capsules and ellipsoids
constexpr int quarter_rings = 16;

/// A ring of vertices about the y axis, with the normal of its vertex at the angle 0.
struct Ring {
    double radius, y;        // m
    double outward, upward;  // components of the normal
    bool joined = false;     // by triangles with the ring below
};

std::vector<Ring> rings_of(const CurvedShape& shape, int rows, int coarser) {
    const double half = 0.5 * shape.height;
    const int quarter = quarter_rings / coarser;
    std::vector<Ring> rings;
    const auto add_quarter = [&](double radius, double center, bool upper, bool joined) {
        for (int i = 0; i <= quarter; ++i) {
            const SinCos angle = sincos(0.5 * pi * (upper ? i : i - quarter) / quarter);
            const bool pole = i == (upper ? quarter : 0);
            const double cosine = pole ? 0.0 : angle.cos;
            rings.push_back({radius * cosine, center + radius * angle.sin, cosine, angle.sin, joined || i > 0});
        }
    };
    switch (shape.kind) {
        case CurvedKind::capsule:
            add_quarter(shape.radius, -half, false, false);
            add_quarter(shape.radius, half, true, true);
            break;
        case CurvedKind::ellipsoid:
            add_quarter(1.0, 0.0, false, false);
            rings.pop_back();
            add_quarter(1.0, 0.0, true, true);
            break;
        case CurvedKind::cylinder:
        case CurvedKind::cone: {
            const double low = shape.radius, high = shape.top_radius, slant = hypotenuse(shape.height, low - high);
            const double outward = shape.height / slant, upward = (low - high) / slant;
            rings = {{0.0, -half, 0.0, -1.0}, {low, -half, 0.0, -1.0, true}, {low, -half, outward, upward}};
            for (int row = 1; row < rows; ++row) {
                const double share = double(row) / rows;
                rings.push_back({low + share * (high - low), -half + share * shape.height, outward, upward, true});
            }
            rings.push_back({high, half, outward, upward, true});
            if (high > 0.0) rings.insert(rings.end(), {{high, half, 0.0, 1.0}, {0.0, half, 0.0, 1.0, true}});
            break;
        }
    }
    return rings;
}

}  // namespace

std::shared_ptr<const MeshAsset> curved_mesh(const CurvedShape& shape, int rows, int coarser) {
    const bool ellipsoid = shape.kind == CurvedKind::ellipsoid;
    const Vec3 scale = ellipsoid ? shape.radii : Vec3(Vec3::Ones());
    const int sides = (ellipsoid || shape.kind == CurvedKind::capsule ? round_sides : flat_sides) / coarser;
    auto asset = std::make_shared<MeshAsset>();
    std::vector<std::uint32_t> welded;  // by vertex for drawing: its index in the mesh
    const std::vector<Ring> rings = rings_of(shape, rows, coarser);
    for (std::size_t k = 0; k < rings.size(); ++k) {
        const Ring& ring = rings[k];
        const bool pole = ring.radius == 0.0;
        const bool known = k > 0 && rings[k - 1].radius == ring.radius && rings[k - 1].y == ring.y;
        const std::size_t first = asset->vertices.size();
        for (int i = 0; i < sides; ++i) {
            const SinCos angle = sincos(2.0 * pi * i / sides);
            const Vec3 position = scale.cwiseProduct(Vec3(ring.radius * angle.sin, ring.y, ring.radius * angle.cos));
            const Vec3 normal =
                Vec3(ring.outward * angle.sin, ring.upward, ring.outward * angle.cos).cwiseQuotient(scale).normalized();
            asset->vertices.push_back({{float(position.x()), float(position.y()), float(position.z())},
                                       {float(normal.x()), float(normal.y()), float(normal.z())}});
            if (known) {
                welded.push_back(welded[first - std::size_t(sides) + std::size_t(i)]);
                continue;
            }
            if (!pole || i == 0) asset->mesh.vertices.push_back(position);
            welded.push_back(std::uint32_t(asset->mesh.vertices.size() - 1));
        }
        if (!ring.joined) continue;
        const auto high = std::uint32_t(first), low = high - std::uint32_t(sides);
        for (std::uint32_t i = 0; i < std::uint32_t(sides); ++i) {
            const std::uint32_t next = (i + 1) % std::uint32_t(sides);
            for (const auto& corners :
                 {std::array{low + i, low + next, high + next}, std::array{low + i, high + next, high + i}}) {
                const std::array<std::uint32_t, 3> triangle{welded[corners[0]], welded[corners[1]], welded[corners[2]]};
                if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
                asset->mesh.triangles.push_back(triangle);
                asset->indices.insert(asset->indices.end(), corners.begin(), corners.end());
            }
        }
    }
    return asset;
}

}  // namespace tumble
