// Batches of instances that share a mesh, and the numbers of the meshes.
#pragma once

#include "render/mesh/instance.h"
#include "render/mesh/mesh_lod.h"

#include <cstddef>
#include <vector>

namespace tumble {

/// The meshes by number: half a box (what the sun sees of it), one face of it, the balls from coarse to fine, the
/// cylinder, then the scene's own, each with its levels of detail.
inline constexpr std::size_t half_box_mesh = 0, face_mesh = 1, first_ball_mesh = 2, ball_levels = 6;
inline constexpr std::size_t cylinder_mesh = first_ball_mesh + ball_levels, first_scene_mesh = cylinder_mesh + 1;

inline std::size_t scene_mesh(std::size_t mesh, std::size_t level) { return first_scene_mesh + mesh * mesh_levels + level; }

struct Batch {
    std::size_t mesh = 0;
    bool patterned = false;
    bool lit = true;                   // false: faces turned away from the sun, which need no look for shadows
    bool wide = false;                 // each pixel finds out which shadow map it lies in
    bool charted = false;              // a mesh that is darkened by the pixel: see mesh_charts.h
    std::size_t first = 0, count = 0;  // of the instances
};

struct DrawList {
    std::vector<Instance> instances;
    std::vector<Batch> visible;  // in the picture
    std::vector<Batch> casters;  // their shadows may be
};

}  // namespace tumble
