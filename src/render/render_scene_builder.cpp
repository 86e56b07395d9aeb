#include "render/render_scene_builder.h"

#include "render/ambient_occlusion/lightmap_selection.h"
#include "render/ambient_occlusion/mesh_occlusion_data.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/scene/distance_outliers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// True for each body near a possible eye position, at the initial poses.
std::vector<char> bodies_near(const SceneDescription& description, const RenderScene& scene) {
    std::vector<Vec3> eyes;
    for (const CameraKeyframe& key : description.camera.keyframes) eyes.push_back(key.eye);
    if (eyes.empty()) eyes.push_back(description.camera.eye);
    std::vector<char> near(scene.bodies.size(), 0);
    std::vector<double> distances, sorted;
    for (const Vec3& eye : eyes) {
        distances.assign(scene.bodies.size(), std::numeric_limits<double>::infinity());
        sorted.clear();
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const RenderBody& proxy = scene.bodies[i];
            if (!(proxy.ao_radius > 0.0) || proxy.large_receiver || proxy.buried) continue;
            distances[i] = (description.bodies[i].position - eye).norm();
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
double plane_cell_for(const SceneDescription& description, const RenderScene& scene) {
    constexpr double stragglers = 0.02, margin = 1.1;
    double extent = 0.0;
    const std::vector<char> near = bodies_near(description, scene);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> at;
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            if (near[i] != 0) at.push_back(description.bodies[i].position[axis]);
        if (at.empty()) break;
        const auto skipped = std::ptrdiff_t(stragglers * double(at.size()));
        std::nth_element(at.begin(), at.begin() + skipped, at.end());
        const double low = at[std::size_t(skipped)];
        std::nth_element(at.begin(), at.end() - 1 - skipped, at.end());
        extent = std::max(extent, *(at.end() - 1 - skipped) - low);
    }
    double cell = std::exp2(std::floor(std::log2(scene.typical_ao_radius / OcclusionAtlas::texels_per_ao_radius)));
    while (margin * extent > cell * (OcclusionAtlas::largest_plane_tile - 64)) cell *= 2.0;
    return cell;
}

}  // namespace

RenderScene make_render_scene(const SceneDescription& description) {
    RenderScene scene = describe_bodies(description);
    for (RenderMesh& mesh : scene.meshes) {
        mesh.occluders = make_mesh_occluders(mesh.asset->mesh);
        set_vertex_samples(mesh);
    }
    scene.plane_cell = plane_cell_for(description, scene);
    select_lightmaps(description, scene);
    return scene;
}

}  // namespace tumble
