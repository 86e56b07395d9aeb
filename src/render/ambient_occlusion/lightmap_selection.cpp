#include "render/ambient_occlusion/lightmap_selection.h"

#include "core/deterministic_math.h"
#include "render/ambient_occlusion/occlusion_atlas.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Vertices (and the few texels of a ball) are too far apart to sample the AO of moving bodies on a body that is this
// many times as large as their AO radius.
constexpr double large_of_ao_radius = 4.0;  // ratio of the body's radius to the AO radius

// for all lightmaps together; 28 bytes each, and five in the atlas. A field of 60 x 60 m under crates of 1 m has
// 230,000
constexpr std::size_t most_texels = 1'200'000;

// Coarser texels would resolve no more than vertices do.
constexpr double fewest_per_ao_radius = 1.0;

constexpr int most_ball_texels = 512;  // per side, so that one region cannot take the whole atlas

// Median AO radius of the bodies that may move; 0 without such bodies.
double movers_ao_radius(const SceneDescription& description, const RenderScene& scene) {
    std::vector<double> ao_radii;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (description.bodies[i].type != BodyType::fixed && scene.bodies[i].ao_radius > 0.0)
            ao_radii.push_back(scene.bodies[i].ao_radius);
    if (ao_radii.empty()) return 0.0;
    const auto middle = ao_radii.begin() + std::ptrdiff_t(ao_radii.size() / 2);
    std::nth_element(ao_radii.begin(), middle, ao_radii.end());
    return *middle;
}

// A mesh with charts, and its area.
struct Charted {
    const MeshAsset* asset;
    std::size_t mesh;
    std::ptrdiff_t surface;
};

bool chart(RenderScene& scene, const RenderBody& proxy, double cell, double coarsest, std::vector<Charted>& charted) {
    const MeshAsset* asset = scene.meshes[proxy.mesh].asset.get();
    for (; cell <= coarsest; cell *= 2.0)
        if (auto charts = make_mesh_charts(*asset, cell, most_texels)) {
            charted.push_back({asset, scene.meshes.size(), std::ptrdiff_t(scene.lightmaps.size())});
            scene.lightmaps.push_back(lightmap_of_mesh(*charts));
            scene.meshes.push_back(scene.meshes[proxy.mesh]);
            scene.meshes.back().charts = std::move(charts);
            return true;
        }
    return false;
}

}  // namespace

void select_lightmaps(const SceneDescription& description, RenderScene& scene) {
    const double ao_radius = movers_ao_radius(description, scene);
    if (!(ao_radius > 0.0)) return;
    const double cell = std::exp2(std::floor(std::log2(ao_radius / OcclusionAtlas::texels_per_ao_radius)));
    std::vector<Charted> charted;
    std::size_t room = most_texels;
    const auto take = [&](std::ptrdiff_t surface) {
        const std::size_t texels = scene.lightmaps[std::size_t(surface)].positions.size();
        if (texels > room) return false;
        room -= texels;
        return true;
    };
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        RenderBody& proxy = scene.bodies[i];
        if (description.bodies[i].type != BodyType::fixed || proxy.bound_radius < large_of_ao_radius * ao_radius)
            continue;
        if (proxy.kind == DrawKind::mesh) {
            const MeshAsset* asset = scene.meshes[proxy.mesh].asset.get();
            auto known =
                std::find_if(charted.begin(), charted.end(), [&](const Charted& c) { return c.asset == asset; });
            if (known == charted.end()) {
                if (!chart(scene, proxy, cell, ao_radius / fewest_per_ao_radius, charted)) {
                    // its values would be many times farther apart than the AO radius of the moving bodies
                    proxy.without_occlusion = true;
                    continue;
                }
                known = charted.end() - 1;
            }
            if (!take(known->surface)) continue;
            proxy.mesh = known->mesh;
            proxy.lightmap = known->surface;
        } else if (proxy.kind == DrawKind::ball) {
            const double texels = std::min(std::ceil(pi * proxy.bound_radius / cell) + 1.0, double(most_ball_texels));
            const auto surface = std::ptrdiff_t(scene.lightmaps.size());
            scene.lightmaps.push_back(lightmap_of_ball(proxy.bound_radius, int(texels)));
            if (take(surface)) proxy.lightmap = surface;
        }
    }
}

}  // namespace tumble
