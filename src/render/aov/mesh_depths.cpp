#include "render/aov/mesh_depths.h"

#include "render/aov/pinhole_camera.h"
#include "scene/description/texel_of.h"

namespace tumble {
namespace {

/// A triangle prepared for rays (x, y, 1). Olano and Greer 1997, Triangle Scan Conversion using 2D Homogeneous
/// Coordinates: a ray d passes on the inner side of the edge a b if (a x b) . d has the sign of the volume of the
/// triangle with the eye. Nothing has to be clipped behind the eye.
struct DepthTriangle {
    std::array<Vec3, 3> edges;  // opposite to each corner, oriented to be positive inside
    Vec3 normal;                // not normalized
    double height;              // normal . corner

    /// False if it is seen edge-on, or from behind although `closed` excludes that.
    bool set(const std::array<Vec3, 3>& corners, bool closed) {
        // From differences, because the large products would cancel for a small and distant triangle.
        normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        height = normal.dot(corners[0]);
        const bool front = height < 0.0;
        if (!(height < 0.0 || height > 0.0) || (closed && !front)) return false;
        for (std::size_t i = 0; i < 3; ++i) {
            edges[i] = corners[(i + 1) % 3].cross(corners[(i + 2) % 3]);
            if (front) edges[i] = -edges[i];
        }
        return true;
    }
};

struct Row {
    double across, rest;  // across x + rest
    Row(const Vec3& v, double ray_y) : across(v.x()), rest(v.y() * ray_y + v.z()) {}
    double at(double x) const { return across * x + rest; }
};

/// True where the texture has a hole. `shares`: of the corners, in any unit.
bool is_hole(const MeshPaint& paint, std::size_t triangle, const std::array<double, 3>& shares) {
    const MeshMaterial& material = paint.materials[paint.material_of_triangle[triangle]];
    if (!material.has_holes()) return false;
    const double sum = shares[0] + shares[1] + shares[2];
    std::array<float, 2> uv{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 2; ++k) uv[k] += float(shares[i] / sum) * paint.corners[3 * triangle + i].uv[k];
    return nearest_texel(material, uv)[3] < material.cutoff;
}

}  // namespace

void find_triangles(const MeshTriangles& mesh, std::uint32_t surface, const PinholeCamera& camera,
                    std::span<const double> ray_x, VisibilityBuffer& map) {
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const std::array<Vec3, 3> corners = {mesh.vertices[mesh.indices[t]], mesh.vertices[mesh.indices[t + 1]],
                                             mesh.vertices[mesh.indices[t + 2]]};
        DepthTriangle triangle;
        if (!triangle.set(corners, mesh.closed)) continue;
        const PixelBounds bounds = pixel_bounds(corners, camera);
        for (int row = bounds.top; !bounds.empty() && row <= bounds.bottom; ++row) {
            const double y = camera.ray_y(row);
            const Row a(triangle.edges[0], y), b(triangle.edges[1], y), c(triangle.edges[2], y);
            const Row fall(triangle.normal, y);
            for (int column = bounds.first; column <= bounds.last; ++column) {
                const double x = ray_x[std::size_t(column)];
                if (!(a.at(x) >= 0.0 && b.at(x) >= 0.0 && c.at(x) >= 0.0)) continue;
                const double depth = triangle.height / fall.at(x);  // edge-on, the sign depends on rounding
                const std::size_t pixel = map.at(column, row);
                if (!(depth > 0.0 && depth < map.depth[pixel])) continue;
                if (mesh.holes && is_hole(*mesh.holes, t / 3, {a.at(x), b.at(x), c.at(x)})) continue;
                map.depth[pixel] = depth;
                map.surface[pixel] = surface;
                map.triangle[pixel] = std::uint32_t(t / 3);
            }
        }
    }
}

}  // namespace tumble
