#include "render/ambient_occlusion/lightmap_selection.h"

#include "core/deterministic_math.h"
#include "render/ambient_occlusion/occlusion_atlas.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Vertices (and the few texels of a ball) are too far apart to sample the AO of moving bodies on a body that is this
// many times as large as their AO radius.
constexpr double large_of_reach = 4.0;  // ratio of the body's radius to the AO radius

// for all lightmaps together; 28 bytes each, and five in the atlas. A field of 60 x 60 m under crates of 1 m has
// 230,000
constexpr std::size_t most_texels = 1'200'000;

// Coarser texels would resolve no more than vertices do.
constexpr double fewest_per_reach = 1.0;

constexpr int most_ball_texels = 512;  // per side, so that one region cannot take the whole atlas

// Median AO radius of the bodies that may move; 0 without such bodies.
double movers_reach(const SceneDescription& scene, const RenderScene& looks) {
    std::vector<double> reaches;
    for (std::size_t i = 0; i < looks.bodies.size(); ++i)
        if (scene.bodies[i].type != BodyType::fixed && looks.bodies[i].reach > 0.0)
            reaches.push_back(looks.bodies[i].reach);
    if (reaches.empty()) return 0.0;
    const auto middle = reaches.begin() + std::ptrdiff_t(reaches.size() / 2);
    std::nth_element(reaches.begin(), middle, reaches.end());
    return *middle;
}

// A mesh with charts, and its area.
struct Charted {
    const MeshAsset* asset;
    std::size_t mesh;
    std::ptrdiff_t surface;
};

bool chart(RenderScene& looks, const RenderBody& look, double cell, double coarsest, std::vector<Charted>& charted) {
    const MeshAsset* asset = looks.meshes[look.mesh].asset;
    for (; cell <= coarsest; cell *= 2.0)
        if (auto charts = make_mesh_charts(*asset, cell, most_texels)) {
            charted.push_back({asset, looks.meshes.size(), std::ptrdiff_t(looks.fine_surfaces.size())});
            looks.fine_surfaces.push_back(fine_surface_of_mesh(*charts));
            looks.meshes.push_back(looks.meshes[look.mesh]);
            looks.meshes.back().charts = std::move(charts);
            return true;
        }
    return false;
}

}  // namespace

void choose_fine_surfaces(const SceneDescription& scene, RenderScene& looks) {
    const double reach = movers_reach(scene, looks);
    if (!(reach > 0.0)) return;
    const double cell = std::exp2(std::floor(std::log2(reach / OcclusionAtlas::texels_per_reach)));
    std::vector<Charted> charted;
    std::size_t room = most_texels;
    const auto take = [&](std::ptrdiff_t surface) {
        const std::size_t texels = looks.fine_surfaces[std::size_t(surface)].positions.size();
        if (texels > room) return false;
        room -= texels;
        return true;
    };
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        RenderBody& look = looks.bodies[i];
        if (scene.bodies[i].type != BodyType::fixed || look.bound_radius < large_of_reach * reach) continue;
        if (look.kind == DrawKind::mesh) {
            const MeshAsset* asset = looks.meshes[look.mesh].asset;
            auto known =
                std::find_if(charted.begin(), charted.end(), [&](const Charted& c) { return c.asset == asset; });
            if (known == charted.end()) {
                if (!chart(looks, look, cell, reach / fewest_per_reach, charted)) {
                    // its values would be many times farther apart than the AO radius of the moving bodies
                    look.undarkened = true;
                    continue;
                }
                known = charted.end() - 1;
            }
            if (!take(known->surface)) continue;
            look.mesh = known->mesh;
            look.fine_surface = known->surface;
        } else if (look.kind == DrawKind::ball) {
            const double texels = std::min(std::ceil(pi * look.bound_radius / cell) + 1.0, double(most_ball_texels));
            const auto surface = std::ptrdiff_t(looks.fine_surfaces.size());
            looks.fine_surfaces.push_back(fine_surface_of_ball(look.bound_radius, int(texels)));
            if (take(surface)) look.fine_surface = surface;
        }
    }
}

}  // namespace tumble
