// Batches of instances that share a mesh, and the indices of the meshes.
#pragma once

#include "render/mesh/mesh_buffer.h"
#include "render/mesh/mesh_lod.h"

#include <cstddef>
#include <vector>

namespace tumble {

/// Mesh indices: half a box (its sides towards the sun), one face of a box, the balls from coarse to fine, the
/// cylinder, then the meshes of the scene, each with its levels of detail.
inline constexpr std::size_t half_box_mesh = 0, face_mesh = 1, first_ball_mesh = 2, ball_levels = 6;
inline constexpr std::size_t cylinder_mesh = first_ball_mesh + ball_levels, first_scene_mesh = cylinder_mesh + 1;

inline std::size_t scene_mesh(std::size_t mesh, std::size_t level) {
    return first_scene_mesh + mesh * mesh_levels + level;
}

/// Features that need another shader, as bits of one number with SurfaceMaps::bits(), which has the lowest three.
namespace surface_feature {
inline constexpr unsigned glowing = 8, translucent = 16;
inline constexpr unsigned sieved = 32;  // of casters: with holes, or translucent
}  // namespace surface_feature

struct Batch {
    std::size_t mesh = 0;
    bool patterned = false;
    bool lit = true;              // false: faces turned away from the sun, which need no shadow lookup
    bool spans_cascades = false;  // each pixel selects its shadow cascade
    bool charted = false;         // a mesh with AO per pixel: see chart_unwrap.h
    bool painted = false;         // a mesh with the colors of its file
    std::size_t look = 0;         // index into RenderScene::looks
    unsigned features = 0;        // bits of surface_feature and SurfaceMaps
    MeshPart part = MeshPart::whole;
    std::size_t first = 0, count = 0;  // of the instances
};

struct DrawList {
    std::vector<Instance> instances;
    std::vector<Batch> visible;       // possibly visible
    std::vector<Batch> translucent;   // the same, farthest first
    std::vector<Batch> casters;       // with a possibly visible shadow
    std::vector<Batch> lamp_casters;  // of the second light with shadows
};

}  // namespace tumble
