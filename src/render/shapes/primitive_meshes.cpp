#include "render/shapes/primitive_meshes.h"

#include "core/deterministic_math.h"

#include <array>
#include <cmath>
#include <map>

namespace tumble {
namespace {

MeshAsset::Vertex vertex(const Vec3& position, const Vec3& normal) {
    return {{float(position.x()), float(position.y()), float(position.z())},
            {float(normal.x()), float(normal.y()), float(normal.z())}};
}

}  // namespace

DrawMesh make_half_box() {
    DrawMesh mesh;
    for (unsigned i = 1; i < 8; ++i) {  // bit k: on the high side of axis k
        const Vec3 corner(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
        mesh.vertices.push_back(vertex(corner, corner.normalized()));
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned high = 1u << axis, u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
        for (const unsigned corner : {high, high | u, high | u | v, high, high | u | v, high | v})
            mesh.indices.push_back(corner - 1);
    }
    return mesh;
}

DrawMesh make_face() {
    DrawMesh mesh;
    for (const auto& [x, y] : {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0), std::pair(-1.0, 1.0)})
        mesh.vertices.push_back(vertex(Vec3(x, y, 0.0), Vec3::UnitZ()));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

DrawMesh make_ball(int level) {
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    std::vector<Vec3> points;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-golden, golden})
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 p = Vec3::Zero();
                p[(axis + 1) % 3] = a;
                p[(axis + 2) % 3] = b;
                points.push_back(p.normalized());
            }
    // The faces are the triples of corners whose mutual distance is the icosahedron's edge length.
    const double edge = 2.0 / std::sqrt(1.0 + golden * golden);
    const auto adjacent = [&](std::size_t i, std::size_t j) { return (points[i] - points[j]).norm() < 1.01 * edge; };
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j)
            for (std::size_t k = j + 1; k < points.size(); ++k) {
                if (!adjacent(i, j) || !adjacent(j, k) || !adjacent(k, i)) continue;
                const bool outward = (points[j] - points[i]).cross(points[k] - points[i]).dot(points[i]) > 0.0;
                faces.push_back({std::uint32_t(i), std::uint32_t(outward ? j : k), std::uint32_t(outward ? k : j)});
            }

    for (int split = 0; split < level; ++split) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t i, std::uint32_t j) {
            const auto [place, is_new] = middles.try_emplace(std::minmax(i, j), std::uint32_t(points.size()));
            if (is_new) points.push_back((points[i] + points[j]).normalized());
            return place->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }

    DrawMesh mesh;
    for (const Vec3& p : points) mesh.vertices.push_back(vertex(p, p));
    for (const auto& face : faces) mesh.indices.insert(mesh.indices.end(), face.begin(), face.end());
    return mesh;
}

DrawMesh make_cylinder(int sides) {
    DrawMesh mesh;
    for (int i = 0; i < sides; ++i) {
        const SinCos angle = sincos(2.0 * pi * i / sides);
        const Vec3 normal(angle.sin, 0.0, angle.cos);
        mesh.vertices.push_back(vertex(normal - Vec3::UnitY(), normal));
        mesh.vertices.push_back(vertex(normal + Vec3::UnitY(), normal));
        const auto low = std::uint32_t(2 * i), next = std::uint32_t(2 * ((i + 1) % sides));
        for (const std::uint32_t corner : {low, next, next + 1, low, next + 1, low + 1}) mesh.indices.push_back(corner);
    }
    for (const double end : {-1.0, 1.0}) {
        const auto first = std::uint32_t(mesh.vertices.size());
        for (int i = 0; i < sides; ++i) {
            const SinCos angle = sincos(2.0 * pi * i / sides);
            mesh.vertices.push_back(vertex(Vec3(angle.sin, end, angle.cos), Vec3(0.0, end, 0.0)));
        }
        for (auto i = first + 1; i + 1 < first + std::uint32_t(sides); ++i) {
            const bool high = end > 0.0;
            for (const std::uint32_t corner : {first, high ? i : i + 1, high ? i + 1 : i})
                mesh.indices.push_back(corner);
        }
    }
    return mesh;
}

}  // namespace tumble
