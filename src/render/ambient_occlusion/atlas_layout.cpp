#include "render/ambient_occlusion/atlas_layout.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int most_tile = 64;
constexpr int most_receiver_tile = 256;  // six of them in a row: crates occlude a receiver of 60 m as finely as a plane

// Resolutions of tiles; the first one with which all tiles fit the budget is taken.
struct Fineness {
    double texels_per_ao_radius;    // of a box's face
    int least_box_tile, ball_tile;  // texels across
};
constexpr Fineness ladder[] = {{OcclusionAtlas::texels_per_ao_radius, 5, 16},
                               {2.0, 5, 16},
                               {1.0, 5, 12},
                               {0.5, 4, 8},
                               {0.25, 3, 6},
                               {0.125, 2, 4}};

int box_tile(const RenderBody& proxy, const RenderScene& scene, const Fineness& fineness) {
    const double edge = 2.0 * proxy.half_size.maxCoeff();
    const double ao_radius = proxy.large_receiver ? std::min(proxy.ao_radius, scene.typical_ao_radius)
                                                  : proxy.ao_radius;  // AO radius of its occluders
    const double texels =
        std::min(std::ceil(fineness.texels_per_ao_radius * edge / ao_radius) + 1.0, double(most_receiver_tile));
    return std::clamp(int(texels), fineness.least_box_tile, proxy.large_receiver ? most_receiver_tile : most_tile);
}

// A body without room in the atlas stays unoccluded.
bool lay_out(const RenderScene& scene, const Fineness& fineness, OcclusionAtlas& atlas) {
    ShelfPacker shelves(1, OcclusionAtlas::most_body_rows);  // texel 0, 0 is unoccluded, for bodies without a place
    bool all = true;
    atlas.places.assign(scene.bodies.size(), {});
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const RenderBody& proxy = scene.bodies[i];
        OcclusionPlace place;
        bool fits = !proxy.solid() || proxy.without_occlusion;
        if (fits) {
            // stays unoccluded
        } else if (proxy.lightmap >= 0) {
            const OcclusionLightmap& surface = scene.lightmaps[std::size_t(proxy.lightmap)];
            place.size = proxy.kind == DrawKind::ball ? surface.width : 1;
            fits = shelves.take(surface.width, surface.height, place.x, place.y);
        } else if (proxy.kind == DrawKind::box) {
            place.size = box_tile(proxy, scene, fineness);
            fits = shelves.take(6 * place.size, place.size, place.x, place.y);
        } else if (proxy.kind == DrawKind::ball) {
            place.size = fineness.ball_tile;
            fits = shelves.take(place.size, place.size, place.x, place.y);
        } else if (proxy.kind == DrawKind::mesh) {
            const int count = int(scene.meshes[proxy.mesh].vertex_samples.size());
            const int rows = (count + OcclusionAtlas::width - 1) / OcclusionAtlas::width;
            place.size = 1;
            fits = shelves.take(rows == 1 ? count : OcclusionAtlas::width, rows, place.x, place.y);
        }
        if (fits) atlas.places[i] = place;
        all = all && fits;
    }
    atlas.height = shelves.end();
    return all;
}

}  // namespace

void lay_out_places(const RenderScene& scene, OcclusionAtlas& atlas) {
    for (const Fineness& fineness : ladder)
        if (lay_out(scene, fineness, atlas)) break;
}

}  // namespace tumble
