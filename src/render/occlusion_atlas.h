// One small picture a frame that holds how open to the sky every visible surface is: a tile for each face of a box, one
// for each ball (octahedral), a run of texels for a mesh's vertices, and a window on each plane around the bodies.
// Sky light changes slowly, so a few texels a face look like a value for every pixel, at a twentieth of the cost.
#pragma once

#include "render/body_looks.h"
#include "render/camera_view.h"
#include "render/sky_openness.h"
#include "render/visibility.h"
#include "sim/snapshot.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Where a body's texels are. A size of 0: nowhere, it is wholly open (texel 0, 0 is).
struct OcclusionPlace {
    int x = 0, y = 0;
    int size = 0;  // a tile's edge; six tiles in a row for a box. Unused for meshes
};

/// The part of a plane around the bodies. A point at the coordinates (a, b) on the plane's axes, in m from the plane
/// body's origin, has the texel (x + a / cell - low_a, y + b / cell - low_b).
struct OcclusionWindow {
    std::size_t body = 0;
    int x = 0, y = 0, width = 0, height = 0;  // texels; the outermost are open
    double cell = 1.0;                        // m
    double low_a = 0.0, low_b = 0.0;          // in cells
};

struct OcclusionAtlas {
    static constexpr int width = 1024;
    int height = 1;
    std::vector<std::uint8_t> texels;    // width * height, 255: open
    std::vector<OcclusionPlace> places;  // of each body
    std::vector<OcclusionWindow> windows;
};

/// For the visible bodies; the others have no place.
OcclusionAtlas make_occlusion_atlas(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view,
                                    const Visibility& visibility);

}  // namespace tumble
