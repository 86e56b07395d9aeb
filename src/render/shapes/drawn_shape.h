// The drawing of each kind of shape: the functions that its file in this folder gives. Compounds are drawn part by
// part.
#pragma once

#include "render/shapes/ray_depths.h"
#include "render/shapes/render_body.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tumble {

/// AO radius of a body: its median half edge; for a plate or rod at most twice its short half edge.
inline double ao_radius_of(const Vec3& half_size) {
    std::array<double, 3> h = {half_size.x(), half_size.y(), half_size.z()};
    std::sort(h.begin(), h.end());
    return std::min(h[1], 2.0 * h[0]);
}

/// A vertex of a surface, in the frame of the shape.
struct SurfaceCorner {
    Vec3 position;  // m
    Vec3 normal;    // unit
};

/// Takes the surface of a shape for the rays of a camera.
class RayTarget {
public:
    using Depths = std::function<void(const RayRow& rays, double* depths)>;
    virtual ~RayTarget() = default;
    /// For the pixels within the hull of the points (camera frame, m). `depths` fills a row.
    virtual void add_rows(std::span<const Vec3> hull, const Depths& depths) = 0;
    /// Triangles with these corners (camera frame, m).
    virtual void add_triangles(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices) = 0;
};

// set_proxy: kind, sizes and bounds of a render proxy; a mesh that is not in `meshes` is appended.
// reach: distance of the farthest drawn point from the origin of the shape, m; infinity for a plane.
// closed: false if the inside of its surface is visible.
// surface_triangles: three corners each, counter-clockwise seen from outside; none for planes and compounds.
// surface_normal: outward and unit, at the intersection of a ray (x, y, 1) at a depth, in the frame of the shape (exact
// for an axis-aligned box); of an open mesh seen from inside, the normal towards the eye. A mesh has its shading
// normal, interpolated between the corners of the triangle.

void set_proxy(RenderBody& proxy, const PlaneShape& shape, std::vector<RenderMesh>& meshes);
double reach(const PlaneShape& shape);
bool closed(const PlaneShape& shape);
std::vector<SurfaceCorner> surface_triangles(const PlaneShape& shape);
void cast_rays(const PlaneShape& shape, const PartPlace& place, RayTarget& target);
Vec3 surface_normal(const PlaneShape& shape, const PartPlace&, std::uint32_t triangle, const Vec3& ray, double depth);

void set_proxy(RenderBody& proxy, const BoxShape& shape, std::vector<RenderMesh>& meshes);
double reach(const BoxShape& shape);
bool closed(const BoxShape& shape);
std::vector<SurfaceCorner> surface_triangles(const BoxShape& shape);
void cast_rays(const BoxShape& shape, const PartPlace& place, RayTarget& target);
Vec3 surface_normal(const BoxShape& shape, const PartPlace&, std::uint32_t triangle, const Vec3& ray, double depth);

void set_proxy(RenderBody& proxy, const SphereShape& shape, std::vector<RenderMesh>& meshes);
double reach(const SphereShape& shape);
bool closed(const SphereShape& shape);
std::vector<SurfaceCorner> surface_triangles(const SphereShape& shape);
void cast_rays(const SphereShape& shape, const PartPlace& place, RayTarget& target);
Vec3 surface_normal(const SphereShape& shape, const PartPlace&, std::uint32_t triangle, const Vec3& ray, double depth);

void set_proxy(RenderBody& proxy, const MeshShape& shape, std::vector<RenderMesh>& meshes);
double reach(const MeshShape& shape);
bool closed(const MeshShape& shape);
std::vector<SurfaceCorner> surface_triangles(const MeshShape& shape);
void cast_rays(const MeshShape& shape, const PartPlace& place, RayTarget& target);
Vec3 surface_normal(const MeshShape& shape, const PartPlace&, std::uint32_t triangle, const Vec3& ray, double depth);

/// A color in linear light as bytes; light above 1 is 1.
Color encoded(const std::array<float, 3>& linear);

/// The color of the file at the intersection of a ray with a triangle, sRGB. Precondition: the shape has paint.
Color painted_color(const MeshShape& mesh, const PartPlace& place, std::uint32_t triangle, const Vec3& ray);

void set_proxy(RenderBody& proxy, const CurvedShape& shape, std::vector<RenderMesh>& meshes);
double reach(const CurvedShape& shape);
bool closed(const CurvedShape& shape);
std::vector<SurfaceCorner> surface_triangles(const CurvedShape& shape);
void cast_rays(const CurvedShape& shape, const PartPlace& place, RayTarget& target);
Vec3 surface_normal(const CurvedShape& shape, const PartPlace&, std::uint32_t triangle, const Vec3& ray, double depth);

void set_proxy(RenderBody& proxy, const CompoundShape& shape, std::vector<RenderMesh>& meshes);
double reach(const CompoundShape& shape);
bool closed(const CompoundShape& shape);
std::vector<SurfaceCorner> surface_triangles(const CompoundShape& shape);
void cast_rays(const CompoundShape& shape, const PartPlace& place, RayTarget& target);
Vec3 surface_normal(const CompoundShape& shape, const PartPlace&, std::uint32_t triangle, const Vec3& ray,
                    double depth);

}  // namespace tumble
