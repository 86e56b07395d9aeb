// One small image with the sky visibility of every visible surface: a tile for each face of a box, an octahedral tile
// for each ball, a run of texels for the vertices of a mesh, and a tile on each plane around the bodies. Sky light
// varies slowly, so a few texels per face are close to a value per pixel, at a twentieth of the cost. Large fixed
// meshes and balls have lightmaps (occlusion_lightmap.h).
// A body has the same place in every frame. Its texels are recomputed only when it or a neighbor has moved. In a scene
// of many bodies, those that are small on the screen get a single value per face (a few for a ball, some tens for a
// mesh). Between both levels of detail values are blended by size, so that they do not jump. The work is bounded by the
// number of pixels of the frame, not by the number of bodies.
#pragma once

#include "render/ambient_occlusion/analytic_occlusion.h"
#include "render/culling/occlusion_culling.h"
#include "render/frame/frame_context.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tumble {

/// Place of a body's texels. Size 0: the body has none and is unoccluded (texel 0, 0 is).
struct OcclusionPlace {
    int x = 0, y = 0;
    int size = 0;  // edge of a tile; a box has six tiles in a row. Unused for meshes
};

/// The part of a plane around the bodies. A point at the coordinates (a, b) on the plane's axes, in m from the plane
/// body's origin, has the texel (x + a / cell - low_a, y + b / cell - low_b).
struct PlaneOcclusionTile {
    std::size_t body = 0;
    int x = 0, y = 0, width = 0, height = 0;  // texels; the outermost are unoccluded
    double cell = 1.0;                        // m
    double low_a = 0.0, low_b = 0.0;          // in cells
    friend bool operator==(const PlaneOcclusionTile&, const PlaneOcclusionTile&) = default;
};

struct OcclusionAtlas {
    static constexpr int width = 2048;
    static constexpr int most_rows = 8192;           // OpenGL 4.1 guarantees 16384; 16 MiB here and as much on the GPU
    static constexpr int most_body_rows = 4096;      // the plane tiles need room as well
    static constexpr int largest_plane_tile = 1024;  // texels; bodies beyond it do not occlude the plane
    static constexpr double texels_per_ao_radius = 4.0;  // sampling density of a body's occlusion
    int height = 1;
    std::vector<std::uint8_t> texels;    // width * height; 255: unoccluded
    std::vector<OcclusionPlace> places;  // of each body
    std::vector<PlaneOcclusionTile> plane_tiles;
};

/// Changes by one update.
struct OcclusionChanges {
    struct Body {
        std::size_t body;
        std::uint8_t faces;  // of a box, as in Visibility; 0: any part of another body
    };
    /// A changed region of a large receiver or of a body with a lightmap: bounds in the body's frame.
    struct Patch {
        std::size_t body;
        Bounds bounds;
    };
    std::vector<Body> bodies;        // without large receivers made of boxes and bodies with lightmaps
    std::vector<Patch> patches;      // of the others
    bool plane_tiles_moved = false;  // a plane tile moved, appeared or disappeared
    int first_row = 0, end_row = 0;  // range of changed texel rows
};

class AmbientOcclusion {
public:
    /// Assigns a place to each body. The scene must outlive it. `reference`: as in add_occluders().
    AmbientOcclusion(const RenderScene& scene, const Vec3& reference);
    ~AmbientOcclusion();

    /// Updates the places of visible bodies and the plane tiles; other bodies keep their texels.
    void update(const FrameContext& frame, const Visibility& visible);

    const OcclusionAtlas& atlas() const;
    /// By the last update.
    const OcclusionChanges& changes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Level of detail, 0 to 1, of a body that is `pixels` across; 0 below `few`, 1 above `all`.
double occlusion_lod(double pixels, double few, double all);

}  // namespace tumble
