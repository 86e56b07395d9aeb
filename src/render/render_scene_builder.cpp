#include "render/render_scene_builder.h"

#include "render/ambient_occlusion/lightmap_selection.h"
#include "render/ambient_occlusion/occluder_boxes.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/ambient_occlusion/vertex_samples.h"
#include "render/scene/distance_outliers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// True for each body near a possible eye position, at the initial poses.
std::vector<char> bodies_near(const SceneDescription& scene, const RenderScene& looks) {
    std::vector<Vec3> eyes;
    for (const CameraKeyframe& key : scene.camera.keyframes) eyes.push_back(key.eye);
    if (eyes.empty()) eyes.push_back(scene.camera.eye);
    std::vector<char> near(looks.bodies.size(), 0);
    std::vector<double> distances, sorted;
    for (const Vec3& eye : eyes) {
        distances.assign(looks.bodies.size(), std::numeric_limits<double>::infinity());
        sorted.clear();
        for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
            if (!(looks.bodies[i].reach > 0.0) || looks.bodies[i].ground) continue;
            distances[i] = (scene.bodies[i].position - eye).norm();
            sorted.push_back(distances[i]);
        }
        if (sorted.empty()) break;
        const double limit = far_limit(sorted);
        for (std::size_t i = 0; i < near.size(); ++i)
            if (distances[i] <= limit) near[i] = 1;
    }
    return near;
}

// A quarter of the typical AO radius, or coarser so that the tile in the atlas contains the bodies at their initial
// poses, without outliers.
double window_cell_for(const SceneDescription& scene, const RenderScene& looks) {
    constexpr double stragglers = 0.02, margin = 1.1;
    double extent = 0.0;
    const std::vector<char> near = bodies_near(scene, looks);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> at;
        for (std::size_t i = 0; i < looks.bodies.size(); ++i)
            if (near[i] != 0) at.push_back(scene.bodies[i].position[axis]);
        if (at.empty()) break;
        const auto skipped = std::ptrdiff_t(stragglers * double(at.size()));
        std::nth_element(at.begin(), at.begin() + skipped, at.end());
        const double low = at[std::size_t(skipped)];
        std::nth_element(at.begin(), at.end() - 1 - skipped, at.end());
        extent = std::max(extent, *(at.end() - 1 - skipped) - low);
    }
    double cell = std::exp2(std::floor(std::log2(looks.typical_reach / OcclusionAtlas::texels_per_reach)));
    while (margin * extent > cell * (OcclusionAtlas::largest_window - 64)) cell *= 2.0;
    return cell;
}

}  // namespace

RenderScene make_render_scene(const SceneDescription& scene) {
    RenderScene looks = describe_bodies(scene);
    for (RenderMesh& mesh : looks.meshes) {
        mesh.occluders = make_mesh_occluders(mesh.asset->mesh);
        set_mesh_probes(mesh);
    }
    looks.window_cell = window_cell_for(scene, looks);
    choose_fine_surfaces(scene, looks);
    return looks;
}

}  // namespace tumble
