// Meshes built in code, with known volumes and inertia tensors.
#pragma once

#include "scene/description/description.h"

#include <cmath>
#include <memory>

namespace tumble::testing {

inline std::shared_ptr<const MeshAsset> asset_of(TriangleMesh mesh) {
    auto asset = std::make_shared<MeshAsset>();
    asset->file = "made in the test";
    asset->mesh = std::move(mesh);
    return asset;
}

/// A box [low, high] as 12 outward triangles.
inline TriangleMesh box_mesh(const Vec3& low, const Vec3& high) {
    TriangleMesh m;
    for (int i = 0; i < 8; ++i)
        m.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
    m.triangles = {{1, 3, 7}, {1, 7, 5}, {0, 4, 6}, {0, 6, 2}, {2, 6, 7}, {2, 7, 3},
                   {0, 1, 5}, {0, 5, 4}, {4, 5, 7}, {4, 7, 6}, {0, 2, 3}, {0, 3, 1}};
    return m;
}

inline TriangleMesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    TriangleMesh m;
    m.vertices = {a, b, c, d};
    m.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return m;
}

inline std::shared_ptr<const MeshAsset> icosahedron(double radius) {
    const double g = 0.5 * (1.0 + std::sqrt(5.0)), s = radius / std::sqrt(1.0 + g * g);
    TriangleMesh m;
    for (const Vec3& v :
         {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g), Vec3(0, 1, g),
          Vec3(0, -1, -g), Vec3(0, 1, -g), Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)})
        m.vertices.push_back(s * v);
    m.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return asset_of(m);
}

/// An open grid of 2 n^2 triangles over [-half, half]^2 with height slope * x.
inline TriangleMesh grid_mesh(int n, double half, double slope) {
    TriangleMesh m;
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) {
            const double x = -half + 2.0 * half * i / n, z = -half + 2.0 * half * k / n;
            m.vertices.emplace_back(x, slope * x, z);
        }
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const auto v = std::uint32_t(i * (n + 1) + k), row = std::uint32_t(n + 1);
            m.triangles.push_back({v, v + 1, v + row});
            m.triangles.push_back({v + 1, v + row + 1, v + row});
        }
    return m;
}

/// Hills and hollows 0.8 m high and deep, 6 by 5 m apart, in a wide bowl.
inline double wavy_height(double x, double z) { return 0.4 * std::sin(x) * std::cos(1.3 * z) + 0.03 * (x * x + z * z); }

/// The same grid at that height.
inline TriangleMesh wavy_mesh(int n, double half) {
    TriangleMesh m = grid_mesh(n, half, 0.0);
    for (Vec3& v : m.vertices) v.y() = wavy_height(v.x(), v.z());
    return m;
}

inline std::shared_ptr<const MeshAsset> open_ramp() { return asset_of(grid_mesh(6, 2.0, 0.3)); }

}  // namespace tumble::testing
