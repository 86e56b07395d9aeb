// One small picture that holds how open to the sky every visible surface is: a tile for each face of a box, one
// for each ball (octahedral), a run of texels for a mesh's vertices, and a window on each plane around the bodies.
// Sky light changes slowly, so a few texels a face look like a value for every pixel, at a twentieth of the cost.
// Large meshes and balls that stand still have texels all over (fine_surface.h).
// A body's place is the same in every frame, and its texels are worked out anew only when it or a neighbor has moved.
// Where there are many bodies, what is small in the picture gets a single value a face (a few for a ball, some tens for
// a mesh); in between the two are mixed, by the size alone, so that nothing jumps. So the work is bounded by the
// picture's pixels, not by the bodies.
#pragma once

#include "render/scene/render_scene.h"
#include "render/camera/camera.h"
#include "render/ambient_occlusion/analytic_occlusion.h"
#include "render/culling/occlusion_culling.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tumble {

/// Where a body's texels are. A size of 0: nowhere, it is wholly open (texel 0, 0 is).
struct OcclusionPlace {
    int x = 0, y = 0;
    int size = 0;  // a tile's edge; six tiles in a row for a box. Unused for meshes
};

/// The part of a plane around the bodies. A point at the coordinates (a, b) on the plane's axes, in m from the plane
/// body's origin, has the texel (x + a / cell - low_a, y + b / cell - low_b).
struct PlaneOcclusionTile {
    std::size_t body = 0;
    int x = 0, y = 0, width = 0, height = 0;  // texels; the outermost are open
    double cell = 1.0;                        // m
    double low_a = 0.0, low_b = 0.0;          // in cells
    friend bool operator==(const PlaneOcclusionTile&, const PlaneOcclusionTile&) = default;
};

struct OcclusionAtlas {
    static constexpr int width = 2048;
    static constexpr int most_rows = 8192;             // OpenGL 4.1 grants 16384; 16 MiB here and there
    static constexpr int most_body_rows = 4096;        // the windows need room as well
    static constexpr int largest_window = 1024;        // texels; bodies beyond it leave the plane open
    static constexpr double texels_per_reach = 4.0;    // how finely a body's darkening is sampled
    int height = 1;
    std::vector<std::uint8_t> texels;    // width * height, 255: open
    std::vector<OcclusionPlace> places;  // of each body
    std::vector<PlaneOcclusionTile> windows;
};

/// What an update changed.
struct OcclusionChanges {
    struct Body {
        std::size_t body;
        std::uint8_t faces;   // of a box, as in Visibility; 0: any part of another body
    };
    /// A part of a ground's face: low and high on the face's axes (see face_part()), from -1 to 1.
    struct Part {
        std::size_t body;
        int face;
        Eigen::Vector2d low, high;
    };
    /// What of a body with a fine surface lies within these bounds of its frame.
    struct Patch {
        std::size_t body;
        Bounds bounds;
    };
    std::vector<Body> bodies;     // but grounds made of boxes, and those with fine surfaces
    std::vector<Part> parts;      // of the former
    std::vector<Patch> patches;   // of the latter
    bool windows_moved = false;   // or appeared, or went: texels of planes are elsewhere
    int first_row = 0, end_row = 0;   // of the texels
};

class AmbientOcclusion {
public:
    /// Gives every body its place. The looks must outlive it. `reference`: as in add_occluders().
    AmbientOcclusion(const RenderScene& looks, const Vec3& reference);
    ~AmbientOcclusion();

    /// Brings the places of visible bodies and the windows up to date; the others keep what they had.
    const OcclusionChanges& update(const Snapshot& snapshot, const Camera& view, const Visibility& visibility);

    const OcclusionAtlas& atlas() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// How much of the full detail a body has that is so many pixels across, 0 to 1; `few` texels below, all above.
double darkening_detail(double pixels, double few, double all);

}  // namespace tumble
