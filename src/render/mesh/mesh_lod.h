// A mesh with as few triangles as its size in the picture needs. Level 0 is the mesh itself; each level after it may leave
// the true surface twice as far as the one before. Which level is drawn depends on the distance alone: the deviation stays
// below a quarter of a pixel (of a texel, in a shadow map), so changing over cannot be seen.
// Levels are made when they are first needed. A scene whose meshes have few triangles together is drawn as it is.
#pragma once

#include "core/triangle_mesh.h"
#include "render/scene/render_scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// A simplified mesh: a choice of the asset's vertices.
struct MeshLod {
    std::vector<MeshAsset::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> probe_of_vertex;   // as in RenderMesh
    TriangleMesh surface;                         // the same triangles, welded: for its outline
};

/// Pixels, or texels of a shadow map, that the drawn surface may be off the true one.
inline constexpr double most_detail_error = 0.25;

inline constexpr std::size_t mesh_levels = 8;

/// Triangles of all bodies together that are drawn whole, however far away: few enough not to matter.
inline constexpr std::size_t most_whole_triangles = 200'000;

/// How far level `level` may be off, m: 0 for level 0, then 1/512 of the mesh's radius, doubled with each.
double deviation_of_level(const RenderBody& look, std::size_t level);

/// The coarsest level that is off by no more than `deviation`, m.
std::size_t level_for(const RenderBody& look, const RenderScene& looks, double deviation);

/// The level to draw a mesh by whose ball is at `center`, relative to the eye.
std::size_t level_in_view(const RenderBody& look, const RenderScene& looks, const Vec3& center, const Camera& view);

/// The levels that were asked for, of all meshes of a scene.
class MeshLods {
public:
    /// The looks must outlive it.
    explicit MeshLods(const RenderScene& looks);

    /// Level 1 or beyond, made now if it was not yet. Every vertex of the mesh lies within deviation_of_level() of it, and
    /// its triangles' corners, middles of sides and centers within as much of the mesh. Where that cannot be had with fewer
    /// triangles it has more, all at worst. A few megabytes a level at most.
    const MeshLod& at(std::size_t mesh, std::size_t level);

private:
    const RenderScene* looks_;
    std::vector<std::optional<MeshLod>> details_;   // mesh by mesh
};

/// Exposed for tests: as `at`, of a mesh by itself, with a deviation of so many meters.
MeshLod simplify(const RenderMesh& mesh, double deviation);

}  // namespace tumble
