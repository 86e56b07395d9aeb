#include "render/ambient_occlusion/atlas_layout.h"

#include "render/ambient_occlusion/shelf_packer.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int most_tile = 64;
constexpr int most_ground_tile = 256;  // six of them in a row: crates occlude a receiver of 60 m as finely as a plane

// Resolutions of tiles; the first one with which all tiles fit the budget is taken.
struct Fineness {
    double texels_per_reach;        // of a box's face
    int least_box_tile, ball_tile;  // texels across
};
constexpr Fineness ladder[] = {
    {OcclusionAtlas::texels_per_reach, 5, 16}, {2.0, 5, 16}, {1.0, 5, 12}, {0.5, 4, 8}, {0.25, 3, 6}, {0.125, 2, 4}};

int box_tile(const RenderBody& look, const RenderScene& looks, const Fineness& fineness) {
    const double edge = 2.0 * look.half_size.maxCoeff();
    const double reach =
        look.ground ? std::min(look.reach, looks.typical_reach) : look.reach;  // AO radius of its occluders
    const double texels = std::min(std::ceil(fineness.texels_per_reach * edge / reach) + 1.0, double(most_ground_tile));
    return std::clamp(int(texels), fineness.least_box_tile, look.ground ? most_ground_tile : most_tile);
}

// A body without room in the atlas stays unoccluded.
bool lay_out(const RenderScene& looks, const Fineness& fineness, OcclusionAtlas& atlas) {
    ShelfPacker shelves(1, OcclusionAtlas::most_body_rows);  // texel 0, 0 is unoccluded, for bodies without a place
    bool all = true;
    atlas.places.assign(looks.bodies.size(), {});
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        const RenderBody& look = looks.bodies[i];
        OcclusionPlace place;
        bool fits = look.kind == DrawKind::hidden || look.kind == DrawKind::plane || look.undarkened;
        if (fits) {
            // stays unoccluded
        } else if (look.fine_surface >= 0) {
            const OcclusionLightmap& surface = looks.fine_surfaces[std::size_t(look.fine_surface)];
            place.size = look.kind == DrawKind::ball ? surface.width : 1;
            fits = shelves.take(surface.width, surface.height, place.x, place.y);
        } else if (look.kind == DrawKind::box) {
            place.size = box_tile(look, looks, fineness);
            fits = shelves.take(6 * place.size, place.size, place.x, place.y);
        } else if (look.kind == DrawKind::ball) {
            place.size = fineness.ball_tile;
            fits = shelves.take(place.size, place.size, place.x, place.y);
        } else if (look.kind == DrawKind::mesh) {
            const int count = int(looks.meshes[look.mesh].probes.size());
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

void lay_out_places(const RenderScene& looks, OcclusionAtlas& atlas) {
    for (const Fineness& fineness : ladder)
        if (lay_out(looks, fineness, atlas)) break;
}

}  // namespace tumble
