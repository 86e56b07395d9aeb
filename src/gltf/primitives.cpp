#include "gltf/primitives.h"

#include "core/deterministic_math.h"
#include "core/vector.h"

namespace tumble {
namespace {

constexpr int sphere_segments = 48, sphere_rings = 24;

std::uint32_t add_vertex(Triangles& t, const Vec3& position, const Vec3& normal) {
    for (int c = 0; c < 3; ++c) t.positions.push_back(float(position[c]));
    for (int c = 0; c < 3; ++c) t.normals.push_back(float(normal[c]));
    return std::uint32_t(t.positions.size() / 3 - 1);
}

/// A square with edges along u and v, for which u x v = normal.
void add_square(Triangles& t, const Vec3& center, const Vec3& u, const Vec3& v, const Vec3& normal) {
    const std::uint32_t first = add_vertex(t, center - u - v, normal);
    add_vertex(t, center + u - v, normal);
    add_vertex(t, center + u + v, normal);
    add_vertex(t, center - u + v, normal);
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) t.indices.push_back(first + corner);
}

}  // namespace

Triangles unit_box() {
    Triangles box;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const Vec3 normal = side * Vec3::Unit(axis), u = 0.5 * Vec3::Unit((axis + 1) % 3);
            add_square(box, 0.5 * normal, u, normal.cross(u), normal);
        }
    return box;
}

Triangles unit_sphere() {
    Triangles sphere;
    for (int ring = 0; ring <= sphere_rings; ++ring) {
        const SinCos polar = sincos(pi * ring / sphere_rings);
        for (int segment = 0; segment <= sphere_segments; ++segment) {
            const SinCos around = sincos(2.0 * pi * segment / sphere_segments);
            const Vec3 p(polar.sin * around.sin, polar.cos, polar.sin * around.cos);
            add_vertex(sphere, p, p);
        }
    }
    constexpr std::uint32_t row = sphere_segments + 1;
    for (std::uint32_t ring = 0; ring < sphere_rings; ++ring)
        for (std::uint32_t segment = 0; segment < sphere_segments; ++segment) {
            const std::uint32_t a = ring * row + segment, b = a + row;
            // At the poles one of the two triangles has no area.
            if (ring > 0)
                for (const std::uint32_t corner : {a, b, a + 1}) sphere.indices.push_back(corner);
            if (ring + 1 < sphere_rings)
                for (const std::uint32_t corner : {a + 1, b, b + 1}) sphere.indices.push_back(corner);
        }
    return sphere;
}

Triangles square(const Vec3& center, const Vec3& normal, double half_side) {
    Triangles patch;
    const Quat turn = rotation_between(Vec3::UnitZ(), normal);
    add_square(patch, center, half_side * (turn * Vec3::UnitX()), half_side * (turn * Vec3::UnitY()), normal);
    return patch;
}

}  // namespace tumble
