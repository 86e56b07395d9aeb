// Level of detail: a mesh with as few triangles as its size on the screen needs. Level 0 is the mesh itself; each
// further level allows twice the deviation from the true surface. The level depends on the distance only: the deviation
// stays below a quarter of a pixel (of a texel in a shadow map), so that a change of level is invisible. Levels are
// made when they are first needed. A scene whose meshes have few triangles in total is drawn at level 0.
#pragma once

#include "core/triangle_mesh.h"
#include "render/scene/render_scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// A simplified mesh: a subset of the asset's vertices.
struct MeshLod {
    std::vector<MeshAsset::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> sample_of_vertex;  // as in RenderMesh
    TriangleMesh surface;                         // the same triangles with welded vertices, for the outline
};

/// largest deviation of the drawn surface from the true one, pixels or texels of a shadow map
inline constexpr double most_detail_error = 0.25;

inline constexpr std::size_t mesh_levels = 8;

/// triangles of all bodies together below which level 0 is drawn at any distance: few enough to cost little
inline constexpr std::size_t most_whole_triangles = 200'000;

/// Largest deviation of a level, m: 0 for level 0, then 1/512 of the mesh's radius, doubled with each level.
double deviation_of_level(const RenderBody& proxy, std::size_t level);

/// The coarsest level with a deviation of at most `deviation`, m.
std::size_t level_for(const RenderBody& proxy, const RenderScene& scene, double deviation);

/// The level of a mesh whose bounding ball is at `center`, m, relative to the eye.
std::size_t level_in_view(const RenderBody& proxy, const RenderScene& scene, const Vec3& center, const Camera& view);

/// The levels in use, of all meshes of a scene.
class MeshLods {
public:
    /// The scene must outlive it.
    explicit MeshLods(const RenderScene& scene);

    /// Level 1 or above; made on first use. Postcondition: every vertex of the mesh is within deviation_of_level() of
    /// the level's surface, and the corners, edge midpoints and centers of the level's triangles are within that
    /// distance of the mesh. A level that cannot satisfy this has more triangles, all in the worst case. A level takes
    /// a few megabytes at most.
    const MeshLod& at(std::size_t mesh, std::size_t level);

private:
    const RenderScene* scene_;
    std::vector<std::optional<MeshLod>> details_;  // by mesh
};

/// For tests: like `at`, for a single mesh, with a deviation in m.
MeshLod simplify(const RenderMesh& mesh, double deviation);

}  // namespace tumble
