// What one frame draws: plain values made from the scene's looks and a snapshot, ready for upload.
// Bodies that share a mesh are one batch of instances, nearest first, so that what is hidden is rejected early.
#pragma once

#include "render/scene/render_scene.h"
#include "render/camera/camera.h"
#include "render/mesh/instance.h"
#include "render/mesh/mesh_lod.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/shadow/shadow_cascades.h"
#include "sim/snapshot/snapshot.h"

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

/// `wanted`, `casting`: of each item of drawn_items.h, whether it is to be drawn where it is visible, and into the shadow
/// maps.
DrawList make_draw_list(const SceneDescription& scene, const RenderScene& looks, const Snapshot& snapshot,
                        const Camera& view, const Visibility& visibility, const OcclusionAtlas& atlas,
                        const ShadowCascades& shadows, const std::vector<char>& wanted,
                        const std::vector<char>& casting);

}  // namespace tumble
